// Selection of landmarks for a map: those that add the most information on a camera's pose where
// they are visible, evenly along the road.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include <Eigen/Core>

#include "mapper/landmarks/landmark_mapper.h"
#include "schema/geo/route_line.h"

namespace milepost {

struct SelectionSettings {
  double place_m = 2;                // spacing of the evaluated places on the line
  double bearing_sigma_rad = 0.004;  // of one observation
  double position_sigma_m = 1;       // prior of a pose without any landmark: ...
  double heading_sigma_rad = 0.1;    // ... arc length and lateral offset, and heading
  double half_repeated_at = 4;       // observations for a probability of 1/2 to be seen again
};

// Greedy selection by the gain in log determinant of the pose's information matrix (D-optimal
// design), summed over the places. Chosen landmarks count for all later tiles. Not safe to use
// from several threads.
class LandmarkSelector {
 public:
  explicit LandmarkSelector(const SelectionSettings& settings) : settings_(settings) {}

  // The indices of `landmarks` in greedy order: each by its gain given those before it.
  std::vector<std::size_t> ranked(const std::vector<MappedLandmark>& landmarks,
                                  const RouteLine& line) const;
  // Adds one to the map.
  void choose(const MappedLandmark& landmark, const RouteLine& line);

 private:
  // The information matrix of arc length, lateral offset and heading at a place.
  using Information = Eigen::Matrix3d;
  using Places = std::map<long, Information>;

  double gain(const MappedLandmark& landmark, const RouteLine& line, const Places& places) const;
  void add(const MappedLandmark& landmark, const RouteLine& line, Places& places) const;
  template <class Visit>
  void visit_observations(const MappedLandmark& landmark, const RouteLine& line, Visit visit) const;
  Information prior() const;

  SelectionSettings settings_;
  Places places_;
};

}  // namespace milepost
