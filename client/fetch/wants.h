// The map data that a vehicle wants to hold.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "client/fetch/map_source.h"

namespace milepost {

struct SegmentKey {
  MapVersion version;
  std::string segment;

  friend bool operator==(const SegmentKey&, const SegmentKey&) = default;
  friend bool operator<(const SegmentKey& a, const SegmentKey& b) {
    return std::tie(a.version, a.segment) < std::tie(b.version, b.segment);
  }
};

// The tiles of one segment that meet a range.
struct Want {
  SegmentKey segment;
  AlongRange range;
  int priority = 0;  // the lowest first
};

// The segments that pass within a radius of a position.
struct Surroundings {
  GeoPoint position;
  double radius_m = 0;
};

// The complete set: what is not in it is no longer wanted.
struct Wants {
  std::optional<Surroundings> around;
  std::vector<Want> tiles;
  std::set<std::string> maps;  // whose current build is asked for: those of successors
};

}  // namespace milepost
