#include "schema/store/map_checks.h"

#include <cmath>
#include <limits>

namespace milepost {
namespace {

Error unstorable(const std::string& where, const std::string& what) {
  return {ErrorCode::invalid_input, where, what, ""};
}

bool is_within(double value, double limit) { return std::abs(value) <= limit; }  // NaN is not

Status check_vertex(const StoredVertex& vertex, const StoredVertex* before,
                    const std::string& where) {
  if (!is_within(vertex.latitude_deg, 90) || !is_within(vertex.longitude_deg, 180)) {
    return unstorable(where, "the position is not a valid latitude and longitude (FORMAT.md 2.5)");
  }
  if (!is_within(vertex.altitude_m, kMaxAltitudeM)) {
    return unstorable(where, "the altitude is more than 100 km (FORMAT.md 2.5)");
  }
  const double least_m = before == nullptr ? 0 : before->along_m;
  if (!(vertex.along_m >= least_m && vertex.along_m <= kMaxAlongM)) {
    return unstorable(where, "along_m does not ascend from 0 (FORMAT.md 2.5)");
  }
  return ok_status();
}

}  // namespace

Status check_segment(const StoredSegment& segment, const std::string& where) {
  if (!is_segment_id(segment.id)) {
    return unstorable(where, "'" + segment.id + "' is not a segment id");
  }
  const std::string place = where + ", segment " + segment.id;
  if (!(segment.length_m > 0 && segment.length_m <= kMaxAlongM)) {
    return unstorable(place, "the length is not above 0 and at most 100000 km (FORMAT.md 2.5)");
  }
  if (segment.vertices.size() < 2) {
    return unstorable(place, "a line needs two or more vertices (FORMAT.md 2.5)");
  }
  const StoredVertex* before = nullptr;
  for (std::size_t i = 0; i < segment.vertices.size(); ++i) {
    const Status vertex =
        check_vertex(segment.vertices[i], before, place + ", vertex " + std::to_string(i));
    if (!vertex) return vertex;
    before = &segment.vertices[i];
  }
  for (const std::string& successor : segment.successors) {
    if (is_segment_id(successor)) continue;
    return unstorable(place, "the successor '" + successor + "' is not a segment id");
  }
  return ok_status();
}

Status check_frame(std::uint64_t bytes, std::uint64_t items, const std::string& where) {
  if (bytes == 0) return unstorable(where, "a tile without bytes (FORMAT.md 2.6)");
  if (bytes > kMaxFrameBytes) return unstorable(where, "a tile of too many bytes (FORMAT.md 2.6)");
  if (items <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
    return ok_status();
  }
  return unstorable(where, "a tile of too many items (FORMAT.md 2.6)");
}

Status check_along(const AlongRange& along, const std::string& where) {
  if (along.from_m <= along.to_m && is_within(along.from_m, kMaxAlongM) &&
      is_within(along.to_m, kMaxAlongM)) {
    return ok_status();
  }
  return unstorable(where, "the along range is not ascending and within 100000 km (FORMAT.md 2.6)");
}

}  // namespace milepost
