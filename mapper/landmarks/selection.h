// Which landmarks earn their place in a map: those that say the most of a camera's pose along the
// stretch where they are seen, evenly along the road.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include <Eigen/Core>

#include "mapper/landmarks/landmark_mapper.h"
#include "schema/geo/route_line.h"

namespace milepost {

struct SelectionSettings {
  double place_m = 2;                // distance of the places on the line where poses are weighed
  double bearing_sigma_rad = 0.004;  // of one sighting
  double position_sigma_m = 1;       // that a place has without any landmark ...
  double heading_sigma_rad = 0.1;    // ... along and across, and of the heading
  double half_repeated_at = 4;       // observations of a landmark that is seen again every second
                                     // time
};

// Greedy choice by the gain in log determinant of what a pose's covariance inverts to (the
// D-optimal design), summed over the places. What was chosen counts for all later tiles. Not safe
// to use from several threads.
class LandmarkSelector {
 public:
  explicit LandmarkSelector(const SelectionSettings& settings) : settings_(settings) {}

  // The indices of `landmarks` in the order of their worth, each after those before it.
  std::vector<std::size_t> ranked(const std::vector<MappedLandmark>& landmarks,
                                  const RouteLine& line) const;
  // Takes one into the map.
  void choose(const MappedLandmark& landmark, const RouteLine& line);

 private:
  // What is known of along, lateral and heading at a place.
  using Information = Eigen::Matrix3d;
  using Places = std::map<long, Information>;

  double gain(const MappedLandmark& landmark, const RouteLine& line, const Places& places) const;
  void add(const MappedLandmark& landmark, const RouteLine& line, Places& places) const;
  template <class Visit>
  void visit_sightings(const MappedLandmark& landmark, const RouteLine& line, Visit visit) const;
  Information prior() const;

  SelectionSettings settings_;
  Places places_;
};

}  // namespace milepost
