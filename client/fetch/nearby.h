// Segments near a position, computed without a server.
#pragma once

#include <string>
#include <vector>

#include "client/fetch/map_source.h"
#include "schema/geo/near.h"

namespace milepost {

// A segment's line, prepared for queries.
struct KnownLine {
  MapVersion version;
  std::string segment;
  double length_m = 0;  // as stored in the map
  BoxedLine line;
};

// Adds the segment to `lines`. A segment whose vertices do not form a line is ignored: it is never
// near.
void add_line(const MapVersion& version, const SegmentDescription& segment,
              std::vector<KnownLine>& lines);

// The segments whose line passes within `radius_m` of the position, ordered by distance, then map
// and id.
std::vector<NearbySegment> lines_near(const std::vector<KnownLine>& lines, const GeoPoint& position,
                                      double radius_m);

// Errors: invalid_input for an invalid position or radius (schema/geo/near.h).
Status check_near_query(const GeoPoint& position, double radius_m);

}  // namespace milepost
