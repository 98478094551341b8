// Dynamic time warping of the driven frames onto the frames of a map, one frame at a time, as
// functions from one row to the next. Müller 2007 (the tracklet paper's [24]): subsequence warping,
// whose first row may begin anywhere.
#pragma once

#include <vector>

namespace milepost {

// The cost c(i, j) >= 0 of matching query frame i with the map's frame j.
struct FrameCost {
  double along_m = 0;  // of the map's frame
  double cost = 0;
};

// The least accumulated cost D(i, j) of all paths that end in query frame i and the map's frame j.
struct WarpCell {
  double along_m = 0;
  double cost = 0;
};

// One query frame over the map's frames of its band, by ascending arc length.
using WarpRow = std::vector<WarpCell>;

// D(0, j) = c(0, j): a path may begin at any frame of the map.
WarpRow first_row(const std::vector<FrameCost>& costs);

// D(i, j) = c(i, j) + min D(i - 1, j') over the map's frames j' from along_j - max_step_m to
// along_j: a vehicle only moves forward, several query frames may match one frame of the map, and
// frames of the map may be skipped. Every path has one cost per query frame, so paths compare
// directly, whatever their slope. Frames that no path reaches are omitted. REQUIRES: costs by
// ascending arc length.
WarpRow next_row(const WarpRow& before, const std::vector<FrameCost>& costs, double max_step_m);

// The cell where the best path ends; the first of equal ones. REQUIRES: the row is not empty.
const WarpCell& best_end(const WarpRow& row);

}  // namespace milepost
