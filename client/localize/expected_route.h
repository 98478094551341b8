// The way that the vehicle is expected to take, as its navigation knows it.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "schema/base/result.h"
#include "schema/geo/route_line.h"

namespace milepost {

// Immutable.
class ExpectedRoute {
 public:
  ExpectedRoute() = default;  // unknown
  // Errors: those of RouteLine::from_vertices.
  static Result<ExpectedRoute> through(std::vector<GeoPoint> positions);

  // Whether it leads over the begin of a segment, in its direction. A route drawn by a navigation
  // lies within 15 m of the road. Unknown, it leads nowhere.
  bool leads_over(const RouteLine& segment) const;

 private:
  std::optional<RouteLine> line_;
};

}  // namespace milepost
