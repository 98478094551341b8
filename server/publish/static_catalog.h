// The documents of a static store that differ from the server's: a store answers no query.
#pragma once

#include <string>
#include <vector>

#include "schema/base/cell_grid.h"
#include "schema/base/result.h"

namespace milepost::server {

// Where a segment lies, for clients that look for those near a position.
struct PlacedSegment {
  std::string map;
  std::string build;
  std::string segment;
  Bounds bounds;  // around its line
};

// /v1/maps, from the server's, and /v1/segments. Both have "static": true.
std::string static_maps_document(const std::string& maps_document);
std::string static_segments_document(const std::vector<PlacedSegment>& segments);

// The box around the line of a segment's document. Errors: corrupt.
Result<Bounds> bounds_of_segment(const std::string& segment_document, const std::string& where);

}  // namespace milepost::server
