// Converts rings of positions to walls.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "schema/tile/wall.h"

namespace milepost {

enum class RingKind { outer, inner };

// Collects the walls of rings; the building is on the right of each.
class RingWalls {
 public:
  // Adds a ring of positions with latitudes in [-90, 90] and longitudes in [-360, 360], in either
  // direction; the last repeats the first, and edges are the shorter way between positions. A ring
  // may go around a pole. Returns an error message for an invalid ring, of which no wall is added.
  // REQUIRES: the ring is not empty.
  std::optional<std::string> add(std::vector<WallEnd> ring, RingKind kind);

  // All walls, except those along longitude 180 with a building on either side.
  std::vector<Wall> finish() &&;

 private:
  // Walls along longitude 180 between the same latitudes, in steps, by their direction.
  struct CutWalls {
    std::vector<Wall> northward;
    std::vector<Wall> southward;
  };

  void add_wall(const Wall& wall);

  std::vector<Wall> walls_;
  std::map<std::pair<std::int64_t, std::int64_t>, CutWalls> on_180_;
};

}  // namespace milepost
