// Dynamic time warping of the frames driven onto the frames of a map, one frame at a time, as
// functions from one row to the next. Müller 2007 (the tracklet paper's [24]): subsequence warping,
// whose first row may begin anywhere.
#pragma once

#include <vector>

namespace milepost {

// The cost c(i, j) >= 0 of taking query frame i for the map's frame j.
struct FrameCost {
  double along_m = 0;  // of the map's frame
  double cost = 0;
};

// The least accumulated cost D(i, j) of all paths that end in query frame i and the map's frame j.
struct WarpCell {
  double along_m = 0;
  double cost = 0;
};

// One query frame over the map's frames of its band, by ascending along.
using WarpRow = std::vector<WarpCell>;

// D(0, j) = c(0, j): a path may begin at each frame of the map.
WarpRow first_row(const std::vector<FrameCost>& costs);

// D(i, j) = c(i, j) + min D(i - 1, j') over the map's frames j' from along_j - max_step_m to
// along_j: a vehicle only moves forward, several query frames may stand for one of the map's and
// frames of the map may be passed over. Every path takes one cost a query frame, so paths compare
// as they are, whatever their slope. Frames that no path reaches are left out. REQUIRES: costs by
// ascending along.
WarpRow next_row(const WarpRow& before, const std::vector<FrameCost>& costs, double max_step_m);

// The cell where the best path ends now; of equals the first. REQUIRES: a row that is not empty.
const WarpCell& best_end(const WarpRow& row);

}  // namespace milepost
