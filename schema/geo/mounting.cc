#include "schema/geo/mounting.h"

namespace milepost {
namespace {

// Moves an attitude by a transform of its own frame.
GeoAttitude moved(const GeoAttitude& from, const Eigen::Isometry3d& from_to) {
  const LocalFrame local(from.position);
  const CameraPose pose = {Eigen::Vector3d::Zero(), from.heading_deg * kRadPerDeg,
                           from.pitch_deg * kRadPerDeg, from.roll_deg * kRadPerDeg};
  const CameraPose to = pose_of(enu_from_camera(pose) * from_to);
  return {local.geo_from_enu({to.enu_m.x(), to.enu_m.y(), to.enu_m.z()}),
          wrapped_360(to.heading_rad * kDegPerRad), to.pitch_rad * kDegPerRad,
          to.roll_rad * kDegPerRad};
}

}  // namespace

Eigen::Isometry3d vehicle_from_camera(const Mounting& mounting) {
  const CameraPose vehicle;  // where forward is north
  const CameraPose camera = {{mounting.right_m, mounting.forward_m, mounting.up_m},
                             mounting.yaw_deg * kRadPerDeg,
                             mounting.pitch_deg * kRadPerDeg,
                             mounting.roll_deg * kRadPerDeg};
  return enu_from_camera(vehicle).inverse() * enu_from_camera(camera);
}

Mounting mounting_of(const Eigen::Isometry3d& vehicle_from_camera) {
  const CameraPose vehicle;  // where forward is north
  const CameraPose camera = pose_of(enu_from_camera(vehicle) * vehicle_from_camera);
  return {camera.enu_m.y(),
          camera.enu_m.x(),
          camera.enu_m.z(),
          camera.heading_rad * kDegPerRad,
          camera.pitch_rad * kDegPerRad,
          camera.roll_rad * kDegPerRad};
}

GeoAttitude camera_of_vehicle(const GeoAttitude& vehicle, const Mounting& mounting) {
  if (mounting.is_at_reference_point()) return vehicle;
  return moved(vehicle, vehicle_from_camera(mounting));
}

GeoAttitude vehicle_of_camera(const GeoAttitude& camera, const Mounting& mounting) {
  if (mounting.is_at_reference_point()) return camera;
  return moved(camera, vehicle_from_camera(mounting).inverse());
}

}  // namespace milepost
