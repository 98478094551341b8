// A segment in stretches of ten metres: what the map has there.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mapper/report/fix_sigma.h"
#include "schema/base/range.h"
#include "schema/document/mapping_record.h"
#include "schema/document/stored_map.h"
#include "schema/geo/route_line.h"
#include "schema/tile/landmark.h"

namespace milepost {

struct MapStretch {
  AlongRange along;             // 10 m; the last of a segment 5 to 15 m
  std::uint64_t landmarks = 0;  // that begin here
  int in_sight = 0;             // landmarks, at the place with the fewest
  int repeated = 0;             // of these, seen by two drives or more
  bool has_gap = false;         // a gap of the segment (mapper/inspect) covers half of it or more
  // Against the map, at the place where the least is known. None without a landmark in sight.
  std::optional<FixSigma> sigma_map = {};
  // In the world, of the worse axis; none where the map does not know its own error.
  std::optional<double> sigma_world_m = {};
  std::vector<StretchFit> fits = {};  // of the images, a drive each; as recorded

  double length_m() const { return along.to_m - along.from_m; }
};

// A landmark with its positions on the Earth.
struct PlacedLandmark {
  Landmark landmark;
  GeoPoint position;
  GeoPoint mapped_from;
  double distance_m = 0;  // between the two
};

std::vector<PlacedLandmark> placed(const LandmarkTile& tile, const RouteLine& line);

struct StretchInput {
  const StoredSegment& segment;
  const RouteLine& line;  // of the segment
  const std::vector<PlacedLandmark>& landmarks;
  const std::vector<AlongRange>& gaps;
  const std::vector<StretchFit>& fits;
  double focal_px = 0;  // of the map's reference camera
};

// The whole segment, in order.
std::vector<MapStretch> stretches_of(const StretchInput& input);

}  // namespace milepost
