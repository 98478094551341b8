#include "mapper/findings/rounded_positions.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "mapper/findings/steps.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

struct PlanCoordinates {
  std::vector<double> a, b;  // latitude and longitude, or east and north
  double metres_of_unit = 1;
};

PlanCoordinates as_given(const Drive& drive) {
  PlanCoordinates given;
  if (drive.position_frame == PositionFrame::geographic) {
    constexpr double kMetresOfDegree = 111320;  // of latitude, about
    given.metres_of_unit = kMetresOfDegree;
    for (const Frame& frame : drive.frames) {
      const GeoPoint position = recorded_pose(drive, frame).position;
      given.a.push_back(position.latitude_deg);
      given.b.push_back(position.longitude_deg);
    }
    return given;
  }
  const LocalFrame local(*drive.origin);
  for (const Frame& frame : drive.frames) {
    const EnuPoint enu = local.enu_from_geo(recorded_pose(drive, frame).position);
    given.a.push_back(enu.east_m);
    given.b.push_back(enu.north_m);
  }
  return given;
}

// Whether all values are multiples of `step`, and enough of them differ.
bool are_rounded(const std::vector<double>& values, double step) {
  constexpr std::size_t kDifferent = 5;
  constexpr double kPart = 1e-3;
  std::set<long long> multiples;
  for (const double value : values) {
    const double steps = value / step;
    if (std::abs(steps - std::round(steps)) > kPart) return false;
    multiples.insert(std::llround(steps));
  }
  return multiples.size() >= kDifferent;
}

}  // namespace

double rounding_step_m(const Drive& drive) {
  constexpr double kLeastM = 0.05;
  constexpr double kGreatestM = 20;
  const PlanCoordinates given = as_given(drive);
  for (int digits = 0; digits < 8; ++digits) {
    const double step = std::pow(10, -digits);
    const double step_m = step * given.metres_of_unit;
    if (step_m > kGreatestM) continue;
    if (step_m < kLeastM) break;
    if (are_rounded(given.a, step) && are_rounded(given.b, step)) return step_m;
  }
  return 0;
}

}  // namespace milepost
