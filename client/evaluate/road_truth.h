// Where a drive really was on the map's roads.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "client/fetch/map_source.h"
#include "client/fetch/wants.h"
#include "client/localize/fix.h"
#include "schema/drive/drive.h"
#include "schema/geo/route_line.h"

namespace milepost {

// A recorded position on a segment.
struct PlaceOnRoad {
  SegmentKey segment;
  double along_m = 0;     // of the nearest point of its line
  double lateral_m = 0;   // from there, positive to the right
  double distance_m = 0;  // from there
};

// Reads each segment and each surrounding once. Not safe to use from several threads at once.
class RoadTruth {
 public:
  // REQUIRES: the source outlives it.
  explicit RoadTruth(MapSource& source) : source_(source) {}

  // The place of a frame's recorded position: the nearest point of the segments that position,
  // heading and altitude belong to. Where several are about as near, as where two lines overlap or
  // a line passes twice, the one nearest to the fix. None off the map. Errors: those of the source.
  Result<std::optional<PlaceOnRoad>> place_of(const Frame& frame, const Fix& fix);

  // The line of a segment. Errors: those of MapSource::segment; invalid_input.
  Result<const RouteLine*> line_of(const SegmentKey& key);

 private:
  Result<std::vector<SegmentKey>> segments_around(const GeoPoint& position,
                                                  const MapVersion& version);

  MapSource& source_;
  std::map<SegmentKey, RouteLine> lines_;
  GeoPoint known_around_;
  double known_radius_m_ = -1;
  std::vector<SegmentKey> known_;
};

}  // namespace milepost
