// The way that the vehicle is expected to take, as its navigation knows it.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "client/fetch/segment_layer.h"
#include "schema/base/result.h"
#include "schema/geo/route_line.h"

namespace milepost {

// Not safe to use from several threads at once.
class ExpectedRoute {
 public:
  ExpectedRoute() = default;  // unknown
  // Errors: those of RouteLine::from_vertices.
  static Result<ExpectedRoute> through(std::vector<GeoPoint> positions);

  // Whether it leads over the begin of a segment, in its direction. A route drawn by a navigation
  // lies within 15 m of the road. Unknown, it leads nowhere.
  bool leads_over(const SegmentLayer& segment) const;

 private:
  bool passes(const GeoPoint& position, double heading_deg) const;

  std::optional<RouteLine> line_;
  mutable std::map<SegmentKey, bool> known_;  // the answers so far: a route may be long
};

}  // namespace milepost
