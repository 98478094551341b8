// Limits of a map's content (FORMAT.md 2): a writer stores nothing that a reader would reject.
#pragma once

#include <cstdint>
#include <string>

#include "schema/base/range.h"
#include "schema/base/result.h"
#include "schema/store/map_store.h"

namespace milepost {

inline constexpr double kMaxAlongM = 1e8;     // of any arc length
inline constexpr double kMaxAltitudeM = 1e5;  // above or below the ellipsoid
inline constexpr std::uint64_t kMaxFrameBytes = 256ULL << 20U;
inline constexpr std::uint64_t kMaxItems = 1ULL << 53U;  // of a tile; exact in every JSON reader

// Whether the segment can be stored. Errors: invalid_input that names, after `where`, the segment
// and the vertex.
Status check_segment(const StoredSegment& segment, const std::string& where);

// Whether a position error can be stored. Errors: invalid_input after `where`.
Status check_position_error(const PositionError& error, const std::string& where);

// Whether the bytes of a tile or a cell with `items` items can be stored. `where` names it.
Status check_frame(std::uint64_t bytes, std::uint64_t items, const std::string& where);

// Whether a tile can have this range. `where` names it.
Status check_along(const AlongRange& along, const std::string& where);

}  // namespace milepost
