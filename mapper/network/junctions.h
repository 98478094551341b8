// Where ways are cut into segments: at the places where the set of passes changes.
#pragma once

#include <optional>
#include <vector>

#include "mapper/network/border.h"
#include "mapper/network/cross_sections.h"
#include "mapper/network/u_turns.h"
#include "mapper/network/way.h"

namespace milepost {

struct Cut {
  double measured_m = 0;  // where the passes change
  double along_m = 0;     // where the way is cut: the nearest multiple on its drive's forward way
  // Whether it stays though the same drives pass before and behind it: an end of a U-turn's arc,
  // or a border.
  bool holds = false;
};

struct JunctionSettings {
  double radius_m = 3;       // changes within a junction's radius are one cut
  double grid_m = 5;         // cuts lie at multiples of this along their drive's forward way
  double min_segment_m = 5;  // a cut nearer to a way's end is left out
  UTurnSettings u_turn;
  std::optional<Border> border;  // roads are cut where they cross it, ...
  // ... being this far beyond it afterwards, or where passes change or a way ends this near.
  double border_reach_m = 10;
};

// The cuts of each way, ascending, without its ends.
std::vector<std::vector<Cut>> junction_cuts(const std::vector<Way>& ways,
                                            const CrossSections& sections,
                                            const JunctionSettings& settings);

}  // namespace milepost
