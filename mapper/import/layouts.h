// The layouts of other programs' recordings.
#pragma once

#include <filesystem>
#include <vector>

#include "mapper/import/recording.h"
#include "schema/base/result.h"

namespace milepost {

struct ImportLayout {
  const char* name;
  std::vector<std::filesystem::path ImportOptions::*> needs;
  Result<Recording> (*read)(const ImportOptions& options);
};

const std::vector<ImportLayout>& import_layouts();

// A trajectory as Applanix writes it: records of 17 doubles, little endian.
Result<Recording> read_sbet(const ImportOptions& options);
// A table with named columns.
Result<Recording> read_csv(const ImportOptions& options);
// GGA and RMC sentences of a receiver.
Result<Recording> read_nmea(const ImportOptions& options);
// Track points of a receiver.
Result<Recording> read_gpx(const ImportOptions& options);
// Images that hold times and positions in their EXIF data.
Result<Recording> read_exif_images(const ImportOptions& options);
// A sequence of KITTI's odometry benchmark: camera poses relative to the first.
Result<Recording> read_kitti_odometry(const ImportOptions& options);
// A drive of KITTI's raw data: a navigation system's packets, images, calibration.
Result<Recording> read_kitti_raw(const ImportOptions& options);
// A model of COLMAP, text or binary, aligned to the Earth.
Result<Recording> read_colmap(const ImportOptions& options);
// Camera poses as TUM's RGB-D benchmark writes them.
Result<Recording> read_tum(const ImportOptions& options);
// A bag of ROS 1 or 2: images, a receiver's positions or odometry, orientations, the camera.
Result<Recording> read_ros1(const ImportOptions& options);
Result<Recording> read_ros2(const ImportOptions& options);

}  // namespace milepost
