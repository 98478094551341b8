// A map of one segment as served by a server, for tests that make the server misbehave.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/fetch/map_source.h"
#include "schema/store/map_store.h"
#include "tests/support/scripted_server.h"

namespace milepost::testing {

// Segment "s1" of the map "town", 200 m straight north, with ten tiles in the layer "tracklets":
// tile k covers [20 k, 20 k + 25] m, so that it reaches 5 m into the next one.
//
//   tile   0         1         2         3   ...   9
//   m      0---------20--------40--------60--      180-------200
//          |-----------|       |-----------|       |-----------|
//                    |-----------|       |-----------|
//
// The layer "walls" has nine cells, three by three, the first with its south-west corner at
// 49 N 8.4 E: cell k is in row k / 3 from the south and column k % 3 from the west.
class FakeMap {
 public:
  FakeMap();

  // The digest of the manifest: another one whenever `index` or `cells` are changed.
  std::string build() const;
  MapVersion version() const { return {"town", build()}; }
  Bytes encoded_tile(std::uint32_t index) const;
  Bytes encoded_cell(std::uint32_t k) const;

  std::string catalog_document() const;
  std::string current_document() const;  // of /v1/maps/town
  std::string manifest() const;
  std::string map_document() const;
  std::string segment_document() const;
  std::string areas_document() const;
  std::string near_document() const;
  // The bytes of the tiles that meet the range.
  std::string range_body(const AlongRange& range) const;
  // The bytes of the cells that meet the box.
  std::string box_body(const Bounds& box) const;

  // The response of a correct server.
  ScriptedAnswer answer(const std::string& target) const;

  std::vector<TileEntry> index;
  std::vector<CellEntry> cells;
  std::string signature;  // of manifest.sig; empty: not signed
};

// An error response of a milepost server.
ScriptedAnswer problem(int status, const std::string& detail);

// The range or box that a target requests; none for other targets.
std::optional<AlongRange> range_of(const std::string& target);
std::optional<Bounds> box_of(const std::string& target);

bool is_tile_target(const std::string& target);
// Whether the target requests cells, not their index.
bool is_cell_target(const std::string& target);

}  // namespace milepost::testing
