#include "client/evaluate/baselines/warping.h"

#include <algorithm>
#include <limits>

namespace milepost {

WarpRow first_row(const std::vector<FrameCost>& costs) {
  WarpRow row;
  row.reserve(costs.size());
  for (const FrameCost& frame : costs) row.push_back({frame.along_m, frame.cost});
  return row;
}

WarpRow next_row(const WarpRow& before, const std::vector<FrameCost>& costs, double max_step_m) {
  WarpRow row;
  for (const FrameCost& frame : costs) {
    double least = std::numeric_limits<double>::infinity();
    for (const WarpCell& cell : before) {
      const double step_m = frame.along_m - cell.along_m;
      if (step_m >= 0 && step_m <= max_step_m) least = std::min(least, cell.cost);
    }
    if (least < std::numeric_limits<double>::infinity()) {
      row.push_back({frame.along_m, least + frame.cost});
    }
  }
  return row;
}

const WarpCell& best_end(const WarpRow& row) {
  return *std::ranges::min_element(row, {}, &WarpCell::cost);
}

}  // namespace milepost
