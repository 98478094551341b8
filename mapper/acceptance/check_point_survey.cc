#include "mapper/acceptance/check_point_survey.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mapper/landmarks/triangulation.h"

namespace milepost {

CheckPointSummary summary_of(const std::vector<CheckPointResidual>& residuals) {
  CheckPointSummary summary;
  summary.marks = residuals.size();
  double plan_m2 = 0;
  double up_m2 = 0;
  for (const CheckPointResidual& residual : residuals) {
    if (!residual.is_placed) continue;
    ++summary.placed;
    const double plan_m = std::hypot(residual.east_m, residual.north_m);
    plan_m2 += plan_m * plan_m;
    up_m2 += residual.up_m * residual.up_m;
    if (summary.worst.empty() || plan_m > summary.worst_plan_m) {
      summary.worst = residual.mark + " by " + residual.drive;
      summary.worst_plan_m = plan_m;
    }
  }
  if (summary.placed == 0) return summary;
  summary.plan_rms_m = std::sqrt(plan_m2 / static_cast<double>(summary.placed));
  summary.up_rms_m = std::sqrt(up_m2 / static_cast<double>(summary.placed));
  return summary;
}

CheckPointSurvey::CheckPointSurvey(std::vector<CheckPoint> points) : points_(std::move(points)) {
  for (const CheckPoint& point : points_) {
    for (const CheckPointSight& sight : point.sights) frames_[{sight.drive, sight.filename}];
  }
}

void CheckPointSurvey::add(const Drive& drive, const std::string& filename, std::size_t stretch,
                           const AdjustedFrame& frame) {
  const auto wanted = frames_.find({drive.name, filename});
  if (wanted != frames_.end()) wanted->second.push_back({stretch, frame});
}

std::vector<CheckPointResidual> CheckPointSurvey::residuals(const std::vector<const Drive*>& drives,
                                                            const ErrorAt& error_at,
                                                            const LineOf& line_of) const {
  std::vector<CheckPointResidual> all;
  for (const CheckPoint& point : points_) {
    for (const Drive* drive : drives) {
      const bool is_seen = std::ranges::find(point.sights, drive->name, &CheckPointSight::drive) !=
                           point.sights.end();
      if (is_seen) all.push_back(residual(point, *drive, error_at, line_of));
    }
  }
  return all;
}

CheckPointResidual CheckPointSurvey::residual(const CheckPoint& point, const Drive& drive,
                                              const ErrorAt& error_at,
                                              const LineOf& line_of) const {
  const GeoPoint& mark = point.position;
  CheckPointResidual residual;
  residual.mark = point.mark;
  residual.drive = drive.name;
  residual.latitude_deg = mark.latitude_deg;
  residual.longitude_deg = mark.longitude_deg;
  residual.altitude_m = mark.altitude_m;
  const LocalFrame local(mark);
  std::vector<CameraPose> poses;
  FeatureTrack track;
  const Placed* middle = nullptr;
  for (const CheckPointSight& sight : point.sights) {
    if (sight.drive != drive.name) continue;
    const auto seen = drive.camera.pinhole_from_image(sight.image_px);
    if (!seen) continue;
    for (const Placed& placed : frames_.at({sight.drive, sight.filename})) {
      const EnuPoint at = local.enu_from_geo(placed.frame.position);
      track.push_back({poses.size(), seen->pinhole_px, seen->magnification});
      poses.push_back({{at.east_m, at.north_m, at.up_m},
                       placed.frame.heading_rad,
                       placed.frame.pitch_rad,
                       placed.frame.roll_rad});
      middle = &placed;
      ++residual.sights;
    }
  }
  if (track.size() < 2) return residual;
  const auto placed = triangulate(track, poses, drive.camera.pinhole, 1);
  if (!placed) return residual;
  const PoseError error = error_at(middle->stretch, middle->frame.along_m);
  const RoadPlace place = road_place(line_of(middle->stretch), middle->frame.along_m);
  const auto in_place = [&](const Eigen::Vector3d& enu_m) -> Eigen::Vector3d {
    const EnuPoint there =
        place.local.enu_from_geo(local.geo_from_enu({enu_m.x(), enu_m.y(), enu_m.z()}));
    return {there.east_m, there.north_m, there.up_m};
  };
  const Eigen::Vector3d mapped_m = in_place(placed->enu_m);
  const Eigen::Vector3d off_m =
      mapped_m - error.displacement_m(place, mapped_m) - in_place(Eigen::Vector3d::Zero());
  residual.is_placed = true;
  residual.east_m = off_m.x();
  residual.north_m = off_m.y();
  residual.up_m = off_m.z();
  residual.reprojection_px = placed->rms_px;
  return residual;
}

}  // namespace milepost
