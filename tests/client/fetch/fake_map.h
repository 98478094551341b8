// A map of one segment as a server would show it, for tests that make the server misbehave.
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
class FakeMap {
 public:
  FakeMap();

  MapVersion version() const { return {"town", build}; }
  Bytes frame(std::uint32_t index) const;

  std::string map_document() const;
  std::string segment_document() const;
  std::string near_document() const;
  // The frames of the tiles that meet the range.
  std::string range_body(const AlongRange& range) const;

  // What a good server answers.
  ScriptedAnswer answer(const std::string& target) const;

  std::string build = "00112233445566778899aabbccddeeff";
  std::vector<TileEntry> index;
};

// The range that a target asks for; nothing for other targets.
std::optional<AlongRange> range_of(const std::string& target);

bool is_tile_target(const std::string& target);

}  // namespace milepost::testing
