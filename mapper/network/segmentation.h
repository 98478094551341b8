// Groups the pieces between cuts into segments.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "mapper/network/cross_sections.h"
#include "mapper/network/junctions.h"

namespace milepost {

// A part of a way between two cuts, or a cut and an end.
struct Piece {
  std::size_t way = 0;
  double from_m = 0, to_m = 0;
  bool end_holds = false;  // whether a segment ends at its end in any case

  Place begin() const { return {way, from_m}; }
  Place end() const { return {way, to_m}; }
};

// The passes of one segment, ordered by place.
using PieceGroup = std::vector<Piece>;

// Pieces are of one segment if each runs beside the other for more than half of the longer one.
// The groups are ordered by their first pieces, and contain every metre of every way once.
std::vector<PieceGroup> grouped_pieces(const std::vector<Way>& ways, const CrossSections& sections,
                                       const std::vector<std::vector<Cut>>& cuts);

// Makes consecutive groups one if the same passes go through both, and nothing else begins or ends
// between them: so segments are as long as can be. Ordered by first pieces.
std::vector<PieceGroup> joined(const std::vector<PieceGroup>& groups);

// The index of the group in which a piece begins at a place.
std::map<Place, std::size_t> groups_by_begin(const std::vector<PieceGroup>& groups);

}  // namespace milepost
