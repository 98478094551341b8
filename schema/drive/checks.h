// Validity checks of a drive, shared by the reader and the writer.
#pragma once

#include <string>
#include <vector>

#include "schema/base/result.h"
#include "schema/drive/drive.h"

namespace milepost {

// The line number of each row in its file, for messages.
struct RowPlaces {
  std::string file;
  std::vector<std::size_t> lines;  // one per row

  std::string place(std::size_t row) const { return file + ", line " + std::to_string(lines[row]); }
};

// Errors name the file (`where`, or the row's location), what is wrong and a hint.
// Errors: invalid_input.
Status check_camera(const Camera& camera, const std::string& where);
Status check_position_error(const StatedPositionError& error, const std::string& where);
Status check_images_folder(const std::string& images, const std::string& where);
// REQUIRES: `rows` has one line per frame (per reading).
Status check_frames(const std::vector<Frame>& frames, const RowPlaces& rows);
Status check_gps(const std::vector<GpsFix>& gps, const RowPlaces& rows);
Status check_odometry(const std::vector<Odometry>& odometry, const RowPlaces& rows);

}  // namespace milepost
