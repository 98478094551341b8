#include "schema/store/map_checks.h"

#include <cmath>
#include <optional>
#include <vector>

#include "schema/base/ids.h"

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

// The names are not quoted: in a damaged file they may hold any bytes.
Status check_successors(const std::vector<Successor>& successors, const std::string& where) {
  for (const Successor& successor : successors) {
    if (!is_segment_id(successor.segment)) {
      return unstorable(where, "a successor is not a segment id (FORMAT.md 2.5)");
    }
    if (!successor.map.empty() && !is_segment_id(successor.map)) {
      return unstorable(where, "a successor's map is not a name (FORMAT.md 2.5)");
    }
  }
  return ok_status();
}

Status check_passes(const std::vector<StoredPass>& passes, const std::string& where) {
  for (const StoredPass& pass : passes) {
    if (!is_segment_id(pass.drive)) {
      return unstorable(where, "a pass's drive is not a name (FORMAT.md 2.5)");
    }
    if (!(pass.from_m >= 0 && pass.from_m <= pass.to_m && pass.to_m <= kMaxAlongM)) {
      return unstorable(where, "a pass's range is not ascending from 0 on (FORMAT.md 2.5)");
    }
  }
  return ok_status();
}

}  // namespace

Status check_position_error(const PositionError& error, const std::string& where) {
  const auto is_distance = [](const std::optional<double>& metres) {
    return !metres || (*metres >= 0 && *metres <= kMaxAlongM);
  };
  if (is_distance(error.sigma_m) && is_distance(error.correlation_m)) return ok_status();
  return unstorable(where, "the position error is not a distance (FORMAT.md 2.5)");
}

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
  if (Status successors = check_successors(segment.successors, place); !successors) {
    return successors;
  }
  if (Status passes = check_passes(segment.passes, place); !passes) return passes;
  return check_position_error(segment.position_error, place);
}

Status check_frame(std::uint64_t bytes, std::uint64_t items, const std::string& where) {
  if (bytes == 0) return unstorable(where, "a tile without bytes (FORMAT.md 2.6)");
  if (bytes > kMaxFrameBytes) return unstorable(where, "a tile of too many bytes (FORMAT.md 2.6)");
  if (items <= kMaxItems) return ok_status();
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
