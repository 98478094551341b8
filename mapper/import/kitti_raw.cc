#include <algorithm>

#include "mapper/import/image_times.h"
#include "mapper/import/layouts.h"
#include "mapper/import/number_lines.h"
#include "schema/base/file.h"
#include "schema/geo/camera_pose.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;

using Rotation = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// The transform of a calibration file: the lines R and T.
Result<Eigen::Isometry3d> transform_in(const fs::path& file) {
  const auto rotation = numbers_of_key(file, "R", 9);
  if (!rotation) return rotation.error();
  const auto translation = numbers_of_key(file, "T", 3);
  if (!translation) return translation.error();
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = Eigen::Map<const Rotation>(rotation->data());
  transform.translation() =
      Eigen::Vector3d((*translation)[0], (*translation)[1], (*translation)[2]);
  return transform;
}

// The left grey camera, rectified, on the navigation system: x forward, y left, z up.
Result<Camera> camera_in(const fs::path& calibration) {
  const auto projection = numbers_of_key(calibration / "calib_cam_to_cam.txt", "P_rect_00", 12);
  if (!projection) return projection.error();
  const auto rectifying = numbers_of_key(calibration / "calib_cam_to_cam.txt", "R_rect_00", 9);
  if (!rectifying) return rectifying.error();
  const auto velodyne_from_imu = transform_in(calibration / "calib_imu_to_velo.txt");
  if (!velodyne_from_imu) return velodyne_from_imu.error();
  const auto camera_from_velodyne = transform_in(calibration / "calib_velo_to_cam.txt");
  if (!camera_from_velodyne) return camera_from_velodyne.error();
  Eigen::Isometry3d rectified_from_camera = Eigen::Isometry3d::Identity();
  rectified_from_camera.linear() = Eigen::Map<const Rotation>(rectifying->data());
  // The vehicle's frame with a camera's axes, x right, y down, z forward.
  Eigen::Isometry3d vehicle_from_imu = Eigen::Isometry3d::Identity();
  vehicle_from_imu.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  const Eigen::Isometry3d vehicle_from_camera =
      vehicle_from_imu *
      (rectified_from_camera * *camera_from_velodyne * *velodyne_from_imu).inverse();
  const std::vector<double>& p = *projection;
  return Camera{0, 0, {p[0], p[5], p[2], p[6]}, {}, mounting_of(vehicle_from_camera)};
}

}  // namespace

// A drive folder with oxts and image_00, the calibration files beside it or in --calibration.
Result<Recording> read_kitti_raw(const ImportOptions& options) {
  const fs::path oxts = options.folder / "oxts";
  const fs::path calibration = options.calibration.empty()
                                   ? fs::absolute(options.folder).lexically_normal().parent_path()
                                   : options.calibration;
  const auto camera = camera_in(calibration);
  if (!camera) return camera.error();
  auto images = timed_images(options.folder / "image_00" / "data",
                             options.folder / "image_00" / "timestamps.txt");
  if (!images) return images.error();
  std::vector<fs::path> packets;
  std::error_code error;
  for (fs::directory_iterator at(oxts / "data", error), end; !error && at != end;
       at.increment(error))
    packets.push_back(at->path());
  if (error) {
    return Error{ErrorCode::not_found, (oxts / "data").string(),
                 "cannot be read (" + error.message() + ")", "name the folder of a drive"};
  }
  std::ranges::sort(packets);
  const Result<std::string> stamps = read_text_file(oxts / "timestamps.txt");
  if (!stamps) return stamps.error();
  Recording recording;
  recording.has_tilts = true;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    const std::size_t end = std::min(stamps->find('\n', begin), stamps->size());
    std::string stamp = stamps->substr(std::min(begin, stamps->size()), end - begin);
    if (stamp.ends_with('\r')) stamp.pop_back();
    const auto time = seconds_of_date(stamp);
    begin = std::min(end + 1, stamps->size());
    if (!time) {
      return Error{ErrorCode::invalid_input,
                   (oxts / "timestamps.txt").string() + ", line " + std::to_string(i + 1),
                   "there is no time for " + packets[i].filename().string(),
                   "restore the file of the drive"};
    }
    // lat, lon, alt, roll, pitch, yaw: metres and radians; yaw counts from east, counterclockwise,
    // and pitch downwards.
    const auto lines = number_lines(packets[i], 6);
    if (!lines) return lines.error();
    const std::vector<double>& v = lines->front().numbers;
    recording.poses.push_back({*time,
                               {{v[0], v[1], v[2]},
                                wrapped_360(90 - v[5] * kDegPerRad),
                                -v[4] * kDegPerRad,
                                v[3] * kDegPerRad}});
  }
  recording.images = std::move(*images);
  recording.camera = *camera;
  return recording;
}

}  // namespace milepost
