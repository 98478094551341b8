#include "client/localize/expected_route.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace milepost {

Result<ExpectedRoute> ExpectedRoute::through(std::vector<GeoPoint> positions) {
  Result<RouteLine> line = RouteLine::from_vertices(std::move(positions));
  if (!line) return line.error();
  ExpectedRoute route;
  route.line_ = std::move(*line);
  return route;
}

bool ExpectedRoute::leads_over(const RouteLine& segment) const {
  constexpr double kBesideM = 15;
  constexpr double kMaxTurnDeg = 60;
  constexpr std::array<double, 2> kLookedAtM = {15, 40};  // where branches have parted
  return line_ && std::ranges::all_of(kLookedAtM, [&](double at_m) {
           const double along_m = std::min(at_m, segment.length_m());
           const LineProjection beside = line_->project(segment.point_at(along_m));
           const double turn =
               turn_deg(line_->heading_deg_at(beside.along_m), segment.heading_deg_at(along_m));
           return beside.distance_m <= kBesideM && std::abs(turn) <= kMaxTurnDeg;
         });
}

}  // namespace milepost
