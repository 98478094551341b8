#include "mapper/import/local_poses.h"

#include "schema/geo/camera_pose.h"

namespace milepost {

Result<LocalFrame> frame_of_origin(const ImportOptions& options) {
  if (options.origin) return LocalFrame(*options.origin);
  return Error{ErrorCode::invalid_input, "--origin", "is required",
               "give latitude, longitude and altitude of the poses' origin"};
}

GeoAttitude attitude_of(const Eigen::Isometry3d& enu_from_camera, const LocalFrame& frame) {
  const CameraPose pose = pose_of(enu_from_camera);
  return {frame.geo_from_enu({pose.enu_m.x(), pose.enu_m.y(), pose.enu_m.z()}),
          wrapped_360(pose.heading_rad * kDegPerRad), pose.pitch_rad * kDegPerRad,
          pose.roll_rad * kDegPerRad};
}

}  // namespace milepost
