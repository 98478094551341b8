// Groups the pieces between cuts into segments.
#pragma once

#include <cstddef>
#include <vector>

#include "mapper/network/cross_sections.h"
#include "mapper/network/junctions.h"

namespace milepost {

// A part of a way between two cuts, or a cut and an end.
struct Piece {
  std::size_t way = 0;
  double from_m = 0, to_m = 0;

  friend bool operator<(const Piece& a, const Piece& b) {
    return a.way != b.way ? a.way < b.way : a.from_m < b.from_m;
  }
};

// The passes of one segment, ordered.
using PieceGroup = std::vector<Piece>;

// Pieces are of one segment if each runs beside the other for more than half of the longer one.
// Consecutive segments with the same passes are one, so segments are as long as can be. The groups
// are ordered by their first pieces, and contain every metre of every way once.
std::vector<PieceGroup> segmentation(const std::vector<Way>& ways, const CrossSections& sections,
                                     const std::vector<std::vector<Cut>>& cuts);

}  // namespace milepost
