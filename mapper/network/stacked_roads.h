// Roads one above the other look like one road in plan.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mapper/network/segmentation.h"
#include "mapper/network/way.h"

namespace milepost {

struct StackedSettings {
  double look_m = 30;            // before and behind an end of a pass
  double max_straight_deg = 25;  // a vehicle that turns by more there has turned into the road
};

// Whether two pieces show the same road, as far as can be said.
using SamePlace = std::function<std::optional<bool>(const Piece& a, const Piece& b)>;

// Pieces of a group that may be of different roads, one above the other.
struct StackedPieces {
  PieceGroup lower, upper;  // which is which is not known
  bool kept_apart = false;  // undecided; else the images decided
};

// Takes groups apart that may be stacked roads: where some drives come from one road and go on to
// another, the rest come from a third and go on to a fourth, none changes between them, all go
// straight, and altitudes are not known. If `ask` cannot say, they stay apart: a road lies in the
// map twice rather than that it leads to where no drive went. Groups in which a drive begins or
// ends stay together.
std::vector<PieceGroup> without_stacked(const std::vector<PieceGroup>& groups,
                                        const std::vector<Way>& ways,
                                        const StackedSettings& settings, const SamePlace& ask,
                                        std::vector<StackedPieces>& told);

}  // namespace milepost
