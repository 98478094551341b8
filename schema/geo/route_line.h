// The line of a segment: capture positions in driving order, parametrized by arc length.
#pragma once

#include <vector>

#include "schema/base/range.h"
#include "schema/base/result.h"
#include "schema/geo/geodesy.h"

namespace milepost {

// The projection of a position on a line: its Frenet coordinates.
struct LineProjection {
  double along_m = 0;  // of the nearest point of the line, [0, length]
  // Signed distance from that point, positive to the right of the line; beyond the line's ends,
  // from its straight continuation.
  double lateral_m = 0;
  double distance_m = 0;  // >= 0
};

// `along_m` is the arc length of geodesics on the ellipsoid's surface from the first vertex
// (the tracklet paper's l, section 3.1.1). Immutable, so safe to share between threads.
class RouteLine {
 public:
  // Errors: invalid_input for fewer than two vertices, an invalid vertex, or a line without length.
  // Vertices that repeat their predecessor's position are allowed.
  static Result<RouteLine> from_vertices(std::vector<GeoPoint> vertices);

  double length_m() const { return along_m_.back(); }
  const std::vector<GeoPoint>& vertices() const { return vertices_; }
  const std::vector<double>& along_m() const { return along_m_; }  // one per vertex, ascending

  // The point of the line at `along_m`, clamped to [0, length].
  GeoPoint point_at(double along_m) const;
  // The direction of the line there, clockwise from north, [0, 360).
  double heading_deg_at(double along_m) const;
  // The nearest point of the line to a position.
  LineProjection project(const GeoPoint& position) const;
  // The nearest point on the part of the line inside `range`, which intersects [0, length].
  LineProjection project(const GeoPoint& position, const AlongRange& range) const;

 private:
  RouteLine(std::vector<GeoPoint> vertices, std::vector<double> along_m);
  std::size_t edge_at(double along_m) const;

  std::vector<GeoPoint> vertices_;
  std::vector<double> along_m_;
  LocalFrame frame_;
  std::vector<EnuPoint> enu_;
};

}  // namespace milepost
