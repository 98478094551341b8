#include "client/fetch/nearby.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace milepost {

void add_line(const MapVersion& version, const SegmentDescription& segment,
              std::vector<KnownLine>& lines) {
  auto line = RouteLine::from_vertices(segment.vertices);
  if (!line.ok()) return;
  lines.push_back({version, segment.id, segment.length_m, BoxedLine(std::move(line).value())});
}

std::vector<NearbySegment> lines_near(const std::vector<KnownLine>& lines, const GeoPoint& position,
                                      double radius_m) {
  std::vector<NearbySegment> found;
  for (const KnownLine& known : lines) {
    const auto nearest = known.line.nearest_within(position, radius_m);
    if (!nearest) continue;
    found.push_back(
        {known.version, known.segment, nearest->along_m, nearest->distance_m, known.length_m});
  }
  std::ranges::sort(found, {}, [](const NearbySegment& near) {
    return std::tie(near.distance_m, near.version.map, near.segment);
  });
  return found;
}

Status check_near_query(const GeoPoint& position, double radius_m) {
  if (is_valid(position) && is_near_radius(radius_m)) return ok_status();
  return Error{ErrorCode::invalid_input, "segments near a position",
               "latitude, longitude or radius is out of range",
               "use WGS84 degrees and a radius of more than 0 and at most 10000 m"};
}

}  // namespace milepost
