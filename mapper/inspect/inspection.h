// What a map holds: its segments, layers, and how densely they are mapped.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "schema/base/range.h"
#include "schema/base/result.h"
#include "schema/store/map_store.h"

namespace milepost {

struct LayerInspection {
  std::string name;
  std::string items;  // what its tiles hold
  std::uint64_t tiles = 0;
  std::uint64_t count = 0;  // of items
  std::uint64_t bytes = 0;
};

struct SegmentInspection {
  StoredSegment stored;
  std::uint64_t landmarks = 0;  // of the default method
  std::uint64_t repeated = 0;   // of these, seen by two drives or more
  std::uint64_t bytes = 0;
  std::vector<AlongRange> gaps;  // where too few landmarks were seen to localize by
};

struct MapInspection {
  std::string file;
  std::string build;
  std::uint64_t bytes = 0;  // of the file
  std::string datum;        // Datum::text; empty: not stated
  Bounds bounds;
  std::vector<LayerInspection> layers;      // by name
  std::vector<SegmentInspection> segments;  // by id

  double length_m() const;
  double gaps_m() const;  // of all segments
};

// Reads all tiles of the default method. Errors: those of MapReader; corrupt (a tile).
Result<MapInspection> inspect(const MapReader& map);

nlohmann::ordered_json to_json(const MapInspection& map);
// The same for people, a line a segment.
std::string text_of(const MapInspection& map);

}  // namespace milepost
