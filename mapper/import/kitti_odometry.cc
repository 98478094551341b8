#include "mapper/import/image_times.h"
#include "mapper/import/layouts.h"
#include "mapper/import/local_poses.h"
#include "mapper/import/number_lines.h"
#include "schema/geo/camera_pose.h"

namespace milepost {

// A sequence folder with times.txt, calib.txt and image_0, and the file of its poses: the rows of
// [R t] from each left camera to the first one.
Result<Recording> read_kitti_odometry(const ImportOptions& options) {
  const auto frame = frame_of_origin(options);
  if (!frame) return frame.error();
  const auto lines = number_lines(options.trajectory, 12);
  if (!lines) return lines.error();
  auto images = timed_images(options.folder / "image_0", options.folder / "times.txt");
  if (!images) return images.error();
  const auto projection = numbers_of_key(options.folder / "calib.txt", "P0", 12);
  if (!projection) return projection.error();
  if (lines->size() != images->size()) {
    return Error{ErrorCode::invalid_input, options.trajectory.string(),
                 "has " + std::to_string(lines->size()) + " poses for " +
                     std::to_string(images->size()) + " images",
                 "give the poses of this sequence"};
  }
  const CameraPose first = {Eigen::Vector3d::Zero(), options.origin_heading_deg * kRadPerDeg, 0, 0};
  Recording recording;
  recording.has_tilts = true;
  recording.are_cameras = true;
  for (std::size_t i = 0; i < lines->size(); ++i) {
    using Rows = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
    Eigen::Isometry3d first_from_camera = Eigen::Isometry3d::Identity();
    first_from_camera.matrix().topRows<3>() = Eigen::Map<const Rows>((*lines)[i].numbers.data());
    recording.poses.push_back({(*images)[i].timestamp_s,
                               attitude_of(enu_from_camera(first) * first_from_camera, *frame)});
  }
  recording.images = std::move(*images);
  const std::vector<double>& p = *projection;
  recording.camera = Camera{0, 0, {p[0], p[5], p[2], p[6]}};
  return recording;
}

}  // namespace milepost
