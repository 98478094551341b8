#include "schema/geo/route_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace milepost {
namespace {

using ::testing::HasSubstr;

const GeoPoint kOrigin{49, 8.4, 0};

// Vertices given in metres about kOrigin.
std::vector<GeoPoint> vertices_at(const std::vector<EnuPoint>& points) {
  const LocalFrame frame(kOrigin);
  std::vector<GeoPoint> vertices;
  vertices.reserve(points.size());
  for (const EnuPoint& point : points) vertices.push_back(frame.geo_from_enu(point));
  return vertices;
}

RouteLine line_through(const std::vector<GeoPoint>& vertices) {
  Result<RouteLine> line = RouteLine::from_vertices(vertices);
  EXPECT_TRUE(line.ok());
  return std::move(line).value();
}

RouteLine line_at(const std::vector<EnuPoint>& points) { return line_through(vertices_at(points)); }

GeoPoint at(double east_m, double north_m) {
  return LocalFrame(kOrigin).geo_from_enu({east_m, north_m, 0});
}

// Compares directions: 359.999 is near 0. The meridian turns by a thousandth of a degree in 100 m.
void expect_heading(const RouteLine& line, double along_m, double expected_deg) {
  const double heading_deg = line.heading_deg_at(along_m);
  EXPECT_GE(heading_deg, 0);
  EXPECT_LT(heading_deg, 360);
  EXPECT_NEAR(std::remainder(heading_deg - expected_deg, 360), 0, 2e-3) << "at " << along_m;
}

// A three-quarter circle of 100 m radius, a vertex every 2 m or so, driven clockwise from its west.
std::vector<GeoPoint> curve() {
  std::vector<EnuPoint> points;
  for (int i = 0; i <= 240; ++i) {
    const double angle = 1.5 * std::numbers::pi * i / 240;
    points.push_back({100 - 100 * std::cos(angle), 100 * std::sin(angle), 0});
  }
  return vertices_at(points);
}

TEST(RouteLine, MeasuresArcLengthByGeodesics) {
  const std::vector<GeoPoint> vertices = curve();
  const RouteLine line = line_through(vertices);
  ASSERT_EQ(line.along_m().size(), vertices.size());
  double along_m = 0;
  EXPECT_EQ(line.along_m()[0], 0);
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    along_m += geodesic_distance_m(vertices[i - 1], vertices[i]);
    EXPECT_DOUBLE_EQ(line.along_m()[i], along_m);
  }
  EXPECT_DOUBLE_EQ(line.length_m(), along_m);
  EXPECT_NEAR(along_m, 150 * std::numbers::pi, 0.01);
}

TEST(RouteLine, IgnoresAltitudeInArcLength) {
  std::vector<GeoPoint> vertices = vertices_at({{0, 0, 0}, {0, 50, 0}, {0, 100, 0}});
  vertices[1].altitude_m = 30;
  EXPECT_NEAR(line_through(vertices).length_m(), 100, 1e-4);
}

TEST(RouteLine, ProjectionUndoesPointAt) {
  const RouteLine line = line_through(curve());
  for (double along_m = 0; along_m <= line.length_m(); along_m += 0.37) {
    const LineProjection projection = line.project(line.point_at(along_m));
    EXPECT_NEAR(projection.along_m, along_m, 1e-4);
    EXPECT_LT(projection.distance_m, 1e-4);
  }
}

TEST(RouteLine, PointAtUndoesProjection) {
  const RouteLine line = line_through(curve());
  for (const GeoPoint& vertex : line.vertices()) {
    const LineProjection projection = line.project(vertex);
    EXPECT_LT(geodesic_distance_m(line.point_at(projection.along_m), vertex), 1e-4);
  }
}

TEST(RouteLine, PointAtKeepsAltitudesBetweenVertices) {
  std::vector<GeoPoint> vertices = vertices_at({{0, 0, 0}, {0, 100, 0}});
  vertices[0].altitude_m = 100;
  vertices[1].altitude_m = 120;
  EXPECT_NEAR(line_through(vertices).point_at(25).altitude_m, 105, 1e-3);
}

TEST(RouteLine, PointAtIsBroughtOntoTheLine) {
  const RouteLine line = line_at({{0, 0, 0}, {0, 100, 0}});
  EXPECT_LT(geodesic_distance_m(line.point_at(-5), line.vertices().front()), 1e-6);
  EXPECT_LT(geodesic_distance_m(line.point_at(500), line.vertices().back()), 1e-6);
}

TEST(RouteLine, HeadingIsThatOfTheEdge) {
  const RouteLine line = line_at({{0, 0, 0}, {0, 100, 0}, {100, 100, 0}, {100, 50, 0}});
  expect_heading(line, -1, 0);
  expect_heading(line, 50, 0);
  expect_heading(line, 150, 90);
  expect_heading(line, 225, 180);
  expect_heading(line, line.length_m(), 180);
  expect_heading(line, 1000, 180);
}

//        | +
//        |      the lateral offset is positive to the right of any direction of driving
//      - |
TEST(RouteLine, LateralIsPositiveToTheRight) {
  const RouteLine north = line_at({{0, 0, 0}, {0, 100, 0}});
  EXPECT_NEAR(north.project(at(3, 40)).lateral_m, 3, 1e-4);
  EXPECT_NEAR(north.project(at(-3, 40)).lateral_m, -3, 1e-4);
  EXPECT_NEAR(north.project(at(-3, 40)).distance_m, 3, 1e-4);
  EXPECT_NEAR(north.project(at(3, 40)).along_m, 40, 1e-4);

  const RouteLine south = line_at({{0, 100, 0}, {0, 0, 0}});
  EXPECT_NEAR(south.project(at(3, 40)).lateral_m, -3, 1e-4);
  EXPECT_NEAR(south.project(at(3, 40)).along_m, 60, 1e-4);

  const RouteLine east = line_at({{0, 0, 0}, {100, 0, 0}});
  EXPECT_NEAR(east.project(at(40, -3)).lateral_m, 3, 1e-4);
}

TEST(RouteLine, LateralOnACurveIsTheDistanceFromIt) {
  const RouteLine line = line_through(curve());
  // Clockwise about (100, 0): the centre lies to the right.
  EXPECT_NEAR(line.project(at(100, 95)).lateral_m, 5, 0.01);
  EXPECT_NEAR(line.project(at(100, 105)).lateral_m, -5, 0.01);
}

TEST(RouteLine, ProjectsBeyondItsEndsOntoThem) {
  const RouteLine line = line_at({{0, 0, 0}, {0, 100, 0}});
  const LineProjection before = line.project(at(3, -4));
  EXPECT_EQ(before.along_m, 0);
  EXPECT_NEAR(before.distance_m, 5, 1e-4);
  EXPECT_NEAR(before.lateral_m, 3, 1e-4);
  const LineProjection behind = line.project(at(-3, 104));
  EXPECT_DOUBLE_EQ(behind.along_m, line.length_m());
  EXPECT_NEAR(behind.lateral_m, -3, 1e-4);
}

//  (0,100) +------+ (20,100)      out on the left, back on the right
//          |      |
//   (0,0)  +      + (20,0)
TEST(RouteLine, ProjectsWithinARange) {
  const RouteLine line = line_at({{0, 0, 0}, {0, 100, 0}, {20, 100, 0}, {20, 0, 0}});
  const GeoPoint position = at(8, 30);  // nearer to the outward part
  EXPECT_NEAR(line.project(position).along_m, 30, 1e-3);
  const LineProjection back = line.project(position, {150, 220});
  EXPECT_NEAR(back.along_m, 190, 1e-3);
  EXPECT_NEAR(back.lateral_m, 12, 1e-3);
  const LineProjection at_start_of_range = line.project(position, {45, 60});
  EXPECT_NEAR(at_start_of_range.along_m, 45, 1e-6);
  EXPECT_NEAR(at_start_of_range.distance_m, std::hypot(8, 15), 1e-3);
  const LineProjection at_end_of_range = line.project(position, {5, 17.5});
  EXPECT_NEAR(at_end_of_range.along_m, 17.5, 1e-6);
  const LineProjection whole = line.project(position, {-10, 1000});
  EXPECT_NEAR(whole.along_m, 30, 1e-3);
}

TEST(RouteLine, AllowsVerticesThatRepeat) {
  const RouteLine line =
      line_at({{0, 0, 0}, {0, 0, 0}, {0, 50, 0}, {0, 50, 0}, {0, 50, 0}, {0, 100, 0}, {0, 100, 0}});
  EXPECT_NEAR(line.length_m(), 100, 1e-4);
  for (const double along_m : {0.0, 25.0, line.along_m()[2], 75.0, line.length_m()}) {
    EXPECT_NEAR(line.project(line.point_at(along_m)).along_m, along_m, 1e-4);
    expect_heading(line, along_m, 0);
  }
}

TEST(RouteLine, MayCloseALoop) {
  const RouteLine line = line_at({{0, 0, 0}, {0, 50, 0}, {50, 50, 0}, {50, 0, 0}, {0, 0, 0}});
  EXPECT_NEAR(line.length_m(), 200, 1e-3);
  const GeoPoint start = line.vertices().front();
  EXPECT_NEAR(line.project(start, {0, 20}).along_m, 0, 1e-4);
  EXPECT_NEAR(line.project(start, {180, 200}).along_m, 200, 1e-3);
  EXPECT_LT(geodesic_distance_m(line.point_at(0), line.point_at(line.length_m())), 1e-6);
}

std::string refusal(const std::vector<GeoPoint>& vertices) {
  const Result<RouteLine> line = RouteLine::from_vertices(vertices);
  if (line) return "accepted";
  EXPECT_EQ(line.error().code, ErrorCode::invalid_input);
  return line.error().line();
}

TEST(RouteLine, RefusesWhatIsNoLine) {
  EXPECT_THAT(refusal({}), HasSubstr("two or more vertices"));
  EXPECT_THAT(refusal({kOrigin}), HasSubstr("two or more vertices"));
  EXPECT_THAT(refusal({kOrigin, kOrigin}), HasSubstr("all vertices lie at one position"));
  EXPECT_THAT(refusal({kOrigin, {91, 0, 0}}), HasSubstr("not a valid latitude and longitude"));
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal({kOrigin, {kNan, 0, 0}}), HasSubstr("not a valid latitude and longitude"));
}

}  // namespace
}  // namespace milepost
