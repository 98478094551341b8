// What a map holds, as values: segments, and the indices of tiles and cells (FORMAT.md 2).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "schema/base/cell_grid.h"
#include "schema/base/range.h"

namespace milepost {

// A vertex of a segment's line.
struct StoredVertex {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double altitude_m = 0;
  double along_m = 0;
};

// A segment on which a vehicle can continue at the end of another.
struct Successor {
  std::string segment;   // is_segment_id
  std::string map = {};  // the neighbour map's name; empty: this map

  friend bool operator==(const Successor&, const Successor&) = default;
};

// One drive's way over a segment.
struct StoredPass {
  std::string drive;  // its name, is_segment_id
  double from_m = 0;  // arc length along the drive where the segment begins ...
  double to_m = 0;    // ... and where it ends

  friend bool operator==(const StoredPass&, const StoredPass&) = default;
};

// How well a segment's positions are known: a map's own error, common to all that lies close.
struct PositionError {
  std::optional<double> sigma_m = {};        // standard deviation
  std::optional<double> correlation_m = {};  // along the road
  bool is_assumed = false;                   // not measured

  friend bool operator==(const PositionError&, const PositionError&) = default;
};

struct StoredSegment {
  std::string id;  // is_segment_id
  double length_m = 0;
  std::vector<StoredVertex> vertices;
  std::vector<Successor> successors;
  std::vector<StoredPass> passes = {};
  PositionError position_error = {};
};

// One row of the tile index.
struct TileEntry {
  std::uint32_t index = 0;
  AlongRange along;         // contains every item's range
  std::uint64_t items = 0;  // tracklets, for the layers of tracklets
  std::uint64_t bytes = 0;
  std::string digest;  // of the encoded tile

  friend bool operator==(const TileEntry& a, const TileEntry& b) {
    return a.index == b.index && a.digest == b.digest;
  }
};

// One row of the index of cells.
struct CellEntry {
  std::uint32_t cell = 0;  // is_cell
  std::uint64_t items = 0;
  std::uint64_t bytes = 0;
  std::string digest;  // of the encoded tile

  friend bool operator==(const CellEntry& a, const CellEntry& b) {
    return a.cell == b.cell && a.digest == b.digest;
  }
};

// By layer, ascending; layers without entries may be absent.
using TileIndices = std::map<std::string, std::vector<TileEntry>>;
using CellIndices = std::map<std::string, std::vector<CellEntry>>;

// What concerns a map as a whole.
struct MapSummary {
  std::map<std::string, std::string> layers;  // name -> parameters, a JSON object
  std::string feature_json = "{}";            // the feature parameters, a JSON object
  Bounds bounds = {};
  std::string datum = {};      // Datum::text; empty: not stated
  std::string mapping = {};    // the document of mapping_record.h; empty: none
  std::uint64_t segments = 0;  // their number ...
  double length_m = 0;         // ... and total length
};

}  // namespace milepost
