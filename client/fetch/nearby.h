// Segments near a position, found without a server.
#pragma once

#include <string>
#include <vector>

#include "client/fetch/map_source.h"
#include "schema/geo/near.h"

namespace milepost {

// A segment's line, ready to be asked.
struct KnownLine {
  MapVersion version;
  std::string segment;
  double length_m = 0;  // as the map says
  BoxedLine line;
};

// Adds the segment to `lines`. One whose vertices make no line is left out: it is never near.
void add_line(const MapVersion& version, const SegmentDescription& segment,
              std::vector<KnownLine>& lines);

// The segments whose line passes within `radius_m` of the position: nearest first; by map and id
// where the distances are equal.
std::vector<NearbySegment> lines_near(const std::vector<KnownLine>& lines, const GeoPoint& position,
                                      double radius_m);

// Errors: invalid_input for a position or radius (schema/geo/near.h) that is none.
Status check_near_query(const GeoPoint& position, double radius_m);

}  // namespace milepost
