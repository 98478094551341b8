#include "mapper/pipeline/stretch_plan.h"

#include "mapper/network/road_network.h"

namespace milepost {

RouteLine part_of(const RouteLine& line, const AlongRange& range) {
  if (range.from_m <= 0 && range.to_m >= line.length_m()) return line;
  const Pass pass{.from_m = range.from_m, .to_m = range.to_m};
  return RouteLine::from_vertices(line_of(pass, line).vertices).value();
}

}  // namespace milepost
