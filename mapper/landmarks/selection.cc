#include "mapper/landmarks/selection.h"

#include <cmath>
#include <queue>
#include <tuple>

#include <Eigen/Dense>

#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr double kNearestM = 2;  // smaller distances do not add information

// The probability that a landmark is seen again: in other frames of a drive, and by other drives.
double probability_of_sight(const MappedLandmark& landmark, double half_repeated_at) {
  constexpr double kPriorSeen = 0.5;
  constexpr double kPriorPasses = 0.5;
  const auto observations = static_cast<double>(landmark.observations);
  const double by_drives = (static_cast<double>(landmark.passes) + kPriorSeen) /
                           (static_cast<double>(landmark.passes_there) + kPriorPasses);
  return by_drives * observations / (observations + half_repeated_at);
}

}  // namespace

LandmarkSelector::Information LandmarkSelector::prior() const {
  const double position = 1 / (settings_.position_sigma_m * settings_.position_sigma_m);
  const double heading = 1 / (settings_.heading_sigma_rad * settings_.heading_sigma_rad);
  return Eigen::Vector3d(position, position, heading).asDiagonal();
}

// Calls visit(place, row) for each place from which the landmark is visible; `row` is the bearing's
// Jacobian by arc length, lateral offset and heading, divided by the bearing's sigma.
template <class Visit>
void LandmarkSelector::visit_observations(const MappedLandmark& landmark, const RouteLine& line,
                                          Visit visit) const {
  const double seen_again = probability_of_sight(landmark, settings_.half_repeated_at);
  const auto first = std::lround(landmark.along.from_m / settings_.place_m);
  const auto last = std::lround(landmark.along.to_m / settings_.place_m);
  for (long place = first; place <= last; ++place) {
    const double along_m = static_cast<double>(place) * settings_.place_m;
    const EnuPoint from_place = LocalFrame(line.point_at(along_m)).enu_from_geo(landmark.position);
    const double heading_rad = line.heading_deg_at(along_m) * kRadPerDeg;
    const double ahead_m =
        from_place.east_m * std::sin(heading_rad) + from_place.north_m * std::cos(heading_rad);
    const double right_m =
        from_place.east_m * std::cos(heading_rad) - from_place.north_m * std::sin(heading_rad);
    const double distance_m = std::max(kNearestM, std::hypot(ahead_m, right_m));
    const double squared = distance_m * distance_m;
    // The landmark's depth error hardly affects its bearing from the lane that it was mapped from,
    // but it does from a lateral offset.
    const double sigma_rad =
        std::hypot(settings_.bearing_sigma_rad,
                   landmark.depth_sigma_m / distance_m * settings_.position_sigma_m / distance_m);
    visit(place, std::sqrt(seen_again) / sigma_rad *
                     Eigen::RowVector3d(right_m / squared, -ahead_m / squared, -1));
  }
}

double LandmarkSelector::gain(const MappedLandmark& landmark, const RouteLine& line,
                              const Places& places) const {
  double sum = 0;
  visit_observations(landmark, line, [&](long place, const Eigen::RowVector3d& row) {
    const auto found = places.find(place);
    const Information& known = found == places.end() ? prior() : found->second;
    sum += std::log1p(row * known.inverse() * row.transpose());
  });
  return sum;
}

void LandmarkSelector::add(const MappedLandmark& landmark, const RouteLine& line,
                           Places& places) const {
  visit_observations(landmark, line, [&](long place, const Eigen::RowVector3d& row) {
    places.try_emplace(place, prior()).first->second += row.transpose() * row;
  });
}

std::vector<std::size_t> LandmarkSelector::ranked(const std::vector<MappedLandmark>& landmarks,
                                                  const RouteLine& line) const {
  // Lazy greedy: gains only fall as others are chosen, so a gain that was computed since the last
  // choice and is still the greatest is the greatest of all.
  struct Candidate {
    double gain;
    std::size_t index;
    std::size_t computed_at;
    bool operator<(const Candidate& other) const {
      return std::tie(gain, other.index) < std::tie(other.gain, index);
    }
  };
  Places places = places_;
  std::priority_queue<Candidate> candidates;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    candidates.push({gain(landmarks[i], line, places), i, 0});
  }
  std::vector<std::size_t> order;
  while (!candidates.empty()) {
    Candidate best = candidates.top();
    candidates.pop();
    if (best.computed_at != order.size()) {
      best.gain = gain(landmarks[best.index], line, places);
      best.computed_at = order.size();
      candidates.push(best);
      continue;
    }
    add(landmarks[best.index], line, places);
    order.push_back(best.index);
  }
  return order;
}

void LandmarkSelector::choose(const MappedLandmark& landmark, const RouteLine& line) {
  add(landmark, line, places_);
}

}  // namespace milepost
