// What makes a drive valid, checked in one place for the reader and the writer.
#pragma once

#include <string>
#include <vector>

#include "schema/base/result.h"
#include "schema/drive/drive.h"

namespace milepost {

// The lines of a file that a sequence of rows stands on, for messages.
struct RowPlaces {
  std::string file;
  std::vector<std::size_t> lines;  // one a row

  std::string place(std::size_t row) const { return file + ", line " + std::to_string(lines[row]); }
};

// Each check names the file (`where`, or the row's place), what is wrong and the mend.
// Errors: invalid_input.
Status check_camera(const Camera& camera, const std::string& where);
Status check_images_folder(const std::string& images, const std::string& where);
// REQUIRES: `rows` has one line a frame (a reading).
Status check_frames(const std::vector<Frame>& frames, const RowPlaces& rows);
Status check_gps(const std::vector<GpsFix>& gps, const RowPlaces& rows);
Status check_odometry(const std::vector<Odometry>& odometry, const RowPlaces& rows);

}  // namespace milepost
