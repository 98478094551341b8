#include "mapper/import/layouts.h"

namespace milepost {

const std::vector<ImportLayout>& import_layouts() {
  constexpr auto kFolder = &ImportOptions::folder;
  constexpr auto kImages = &ImportOptions::images;
  constexpr auto kTrajectory = &ImportOptions::trajectory;
  static const std::vector<ImportLayout> kLayouts = {
      {"sbet", {kTrajectory, kImages}, read_sbet},
      {"csv", {kTrajectory, kImages}, read_csv},
      {"nmea", {kTrajectory, kImages}, read_nmea},
      {"gpx", {kTrajectory, kImages}, read_gpx},
      {"exif", {kImages}, read_exif_images},
      {"kitti-odometry", {kFolder, kTrajectory}, read_kitti_odometry},
      {"kitti-raw", {kFolder}, read_kitti_raw},
      {"colmap", {kFolder, kImages}, read_colmap},
      {"tum", {kTrajectory, kImages}, read_tum},
      {"ros1", {kTrajectory}, read_ros1},
      {"ros2", {kTrajectory}, read_ros2}};
  return kLayouts;
}

}  // namespace milepost
