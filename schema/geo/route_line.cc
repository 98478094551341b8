#include "schema/geo/route_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace milepost {
namespace {

GeoPoint on_ellipsoid(const GeoPoint& point) {
  return {point.latitude_deg, point.longitude_deg, 0};
}

std::vector<double> along_of(const std::vector<GeoPoint>& vertices) {
  std::vector<double> along_m(vertices.size(), 0.0);
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    along_m[i] = along_m[i - 1] + geodesic_distance_m(vertices[i - 1], vertices[i]);
  }
  return along_m;
}

}  // namespace

Result<RouteLine> RouteLine::from_vertices(std::vector<GeoPoint> vertices) {
  for (const GeoPoint& vertex : vertices) {
    if (!is_valid(vertex)) {
      return Error{ErrorCode::invalid_input, "route line",
                   "a vertex is not a valid latitude and longitude", ""};
    }
  }
  if (vertices.size() < 2) {
    return Error{ErrorCode::invalid_input, "route line", "a line needs two or more vertices", ""};
  }
  std::vector<double> along_m = along_of(vertices);
  if (along_m.back() <= 0) {
    return Error{ErrorCode::invalid_input, "route line", "all vertices lie at one position", ""};
  }
  return RouteLine(std::move(vertices), std::move(along_m));
}

RouteLine::RouteLine(std::vector<GeoPoint> vertices, std::vector<double> along_m)
    : vertices_(std::move(vertices)),
      along_m_(std::move(along_m)),
      frame_(on_ellipsoid(vertices_[vertices_.size() / 2])) {
  enu_.reserve(vertices_.size());
  for (const GeoPoint& vertex : vertices_)
    enu_.push_back(frame_.enu_from_geo(on_ellipsoid(vertex)));
}

// The index of the first vertex of the edge of non-zero length that contains `along_m`.
std::size_t RouteLine::edge_at(double along_m) const {
  const double inside_m = std::clamp(along_m, 0.0, length_m());
  auto end = std::upper_bound(along_m_.begin(), along_m_.end(), inside_m);
  if (end == along_m_.end()) end = std::lower_bound(along_m_.begin(), along_m_.end(), length_m());
  return static_cast<std::size_t>(end - along_m_.begin()) - 1;
}

GeoPoint RouteLine::point_at(double along_m) const {
  const std::size_t i = edge_at(along_m);
  const double inside_m = std::clamp(along_m, 0.0, length_m());
  const double part = (inside_m - along_m_[i]) / (along_m_[i + 1] - along_m_[i]);
  const auto between = [part](double a, double b) { return a + part * (b - a); };
  const EnuPoint& a = enu_[i];
  const EnuPoint& b = enu_[i + 1];
  GeoPoint point = frame_.geo_from_enu(
      {between(a.east_m, b.east_m), between(a.north_m, b.north_m), between(a.up_m, b.up_m)});
  point.altitude_m = between(vertices_[i].altitude_m, vertices_[i + 1].altitude_m);
  return point;
}

double RouteLine::heading_deg_at(double along_m) const {
  const std::size_t i = edge_at(along_m);
  return geodesic_azimuth_deg(vertices_[i], vertices_[i + 1]);
}

LineProjection RouteLine::project(const GeoPoint& position) const {
  return project(position, {0, length_m()});
}

LineProjection RouteLine::project(const GeoPoint& position, const AlongRange& range) const {
  const EnuPoint p = frame_.enu_from_geo(on_ellipsoid(position));
  LineProjection nearest;
  nearest.distance_m = std::numeric_limits<double>::infinity();
  const std::size_t last = edge_at(range.to_m);
  for (std::size_t i = edge_at(range.from_m); i <= last; ++i) {
    const double edge_m = along_m_[i + 1] - along_m_[i];
    if (edge_m <= 0) continue;
    const double east = enu_[i + 1].east_m - enu_[i].east_m;
    const double north = enu_[i + 1].north_m - enu_[i].north_m;
    const double squared = east * east + north * north;
    const double from_part = std::clamp((range.from_m - along_m_[i]) / edge_m, 0.0, 1.0);
    const double to_part = std::clamp((range.to_m - along_m_[i]) / edge_m, 0.0, 1.0);
    const double dot = (p.east_m - enu_[i].east_m) * east + (p.north_m - enu_[i].north_m) * north;
    const double part = std::clamp(dot / squared, from_part, to_part);
    const double off_east = p.east_m - (enu_[i].east_m + part * east);
    const double off_north = p.north_m - (enu_[i].north_m + part * north);
    const double distance_m = std::hypot(off_east, off_north);
    if (distance_m < nearest.distance_m) {
      const double along_m = along_m_[i] + part * edge_m;
      const double across_m = (off_east * north - off_north * east) / std::sqrt(squared);
      const bool beyond_end = along_m <= 0 || along_m >= length_m();
      const double lateral_m = beyond_end ? across_m : std::copysign(distance_m, across_m);
      nearest = {along_m, lateral_m, distance_m};
    }
  }
  return nearest;
}

}  // namespace milepost
