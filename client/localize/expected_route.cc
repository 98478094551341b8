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

bool ExpectedRoute::leads_over(const SegmentLayer& segment) const {
  if (!line_) return false;
  const auto [answer, is_new] = known_.try_emplace(segment.key, false);
  if (!is_new) return answer->second;
  constexpr std::array<double, 2> kLookedAtM = {15, 40};  // where branches have parted
  answer->second = std::ranges::all_of(kLookedAtM, [&](double at_m) {
    const double along_m = std::min(at_m, segment.line.length_m());
    return passes(segment.line.point_at(along_m), segment.line.heading_deg_at(along_m));
  });
  return answer->second;
}

// Whether any of its passages leads by a position in a heading: it may pass in both directions.
bool ExpectedRoute::passes(const GeoPoint& position, double heading_deg) const {
  constexpr double kBesideM = 15;
  constexpr double kMaxTurnDeg = 60;
  constexpr double kPieceM = 50;  // in which one passage is looked for
  const auto pieces = static_cast<int>(std::ceil(line_->length_m() / kPieceM));
  for (int piece = 0; piece < pieces; ++piece) {
    const double from_m = piece * kPieceM;
    const LineProjection beside = line_->project(position, {from_m, from_m + kPieceM});
    if (beside.distance_m > kBesideM) continue;
    const double turn = turn_deg(line_->heading_deg_at(beside.along_m), heading_deg);
    if (std::abs(turn) <= kMaxTurnDeg) return true;
  }
  return false;
}

}  // namespace milepost
