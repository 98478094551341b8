#include "mapper/import/image_times.h"
#include "mapper/import/layouts.h"
#include "mapper/import/local_poses.h"
#include "mapper/import/number_lines.h"

namespace milepost {

// A line "timestamp tx ty tz qx qy qz qw": the camera (x right, y down, z forward) in a frame with
// z upwards, whose x is taken as east if no heading is given.
Result<Recording> read_tum(const ImportOptions& options) {
  const auto frame = frame_of_origin(options);
  if (!frame) return frame.error();
  const auto lines = number_lines(options.trajectory, 8);
  if (!lines) return lines.error();
  const Eigen::Isometry3d enu_from_world(
      Eigen::AngleAxisd(-options.origin_heading_deg * kRadPerDeg, Eigen::Vector3d::UnitZ()));
  Recording recording;
  recording.has_tilts = true;
  recording.are_cameras = true;
  for (const NumberLine& line : *lines) {
    const std::vector<double>& v = line.numbers;
    const Eigen::Quaterniond rotation(v[7], v[4], v[5], v[6]);
    if (!(std::abs(rotation.norm() - 1) < 0.01)) {
      return Error{ErrorCode::invalid_input,
                   options.trajectory.string() + ", line " + std::to_string(line.line),
                   "the last four numbers are no unit quaternion",
                   "write timestamp tx ty tz qx qy qz qw"};
    }
    Eigen::Isometry3d world_from_camera(rotation.normalized());
    world_from_camera.pretranslate(Eigen::Vector3d(v[1], v[2], v[3]));
    recording.poses.push_back({v[0], attitude_of(enu_from_world * world_from_camera, *frame)});
  }
  if (const Status added = add_images(options, recording); !added) return added.error();
  return recording;
}

}  // namespace milepost
