#include "schema/geo/geodesy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace milepost {
namespace {

// GeographicLib's own published cases, as `latitude longitude latitude longitude distance`.
struct GeodesicCase {
  const char* source;
  GeoPoint from, to;
  double distance_m;
  double tolerance_m;
};

class GeodesicCases : public ::testing::TestWithParam<GeodesicCase> {};

TEST_P(GeodesicCases, HaveTheirPublishedLength) {
  const GeodesicCase& published = GetParam();
  EXPECT_NEAR(geodesic_distance_m(published.from, published.to), published.distance_m,
              published.tolerance_m)
      << published.source;
  EXPECT_NEAR(geodesic_distance_m(published.to, published.from), published.distance_m,
              published.tolerance_m)
      << published.source;
}

const GeodesicCase kGeodesicCases[] = {
    {"documentation, JFK to LHR", {40.6, -73.8, 0}, {51.6, -0.5, 0}, 5551759.400, 5e-4},
    {"documentation, Wellington to Salamanca",
     {-41.32, 174.81, 0},
     {40.96, -5.50, 0},
     19959679.267,
     5e-4},
    {"test GeodSolve0, JFK to CDG", {40.6, -73.8, 0}, {49.01666667, 2.55, 0}, 5853226, 0.5},
    {"test GeodSolve4, a short line",
     {36.493349428792, 0, 0},
     {36.49334942879201, 0.0000008, 0},
     0.072,
     5e-4},
    {"test GeodSolve6, nearly antipodal",
     {88.202499451857, 0, 0},
     {-88.202499451857, 179.981022032992859592, 0},
     20003898.214,
     5e-4},
    {"test GeodSolve9, nearly antipodal",
     {56.320923501171, 0, 0},
     {-56.320923501171, 179.664747671772880215, 0},
     19993558.287,
     5e-4},
    {"GeodTest, 1", {35.60777, -139.44815, 0}, {-11.17491, -69.95921, 0}, 8935244.5604818305, 1e-6},
    {"GeodTest, 2", {55.52454, 106.05087, 0}, {77.03196, -162.81766, 0}, 4105086.1713924406, 1e-6},
    {"GeodTest, 3", {-21.97856, 142.59065, 0}, {41.84138, 98.56635, 0}, 8394328.894657671, 1e-6},
};

INSTANTIATE_TEST_SUITE_P(GeographicLib, GeodesicCases, ::testing::ValuesIn(kGeodesicCases));

TEST(Geodesic, IgnoresAltitude) {
  EXPECT_DOUBLE_EQ(geodesic_distance_m({49, 8, 0}, {49.001, 8, 500}),
                   geodesic_distance_m({49, 8, 0}, {49.001, 8, 0}));
}

TEST(Geodesic, AzimuthIsClockwiseFromNorth) {
  // Published with three of the distances above.
  EXPECT_NEAR(geodesic_azimuth_deg({40.6, -73.8, 0}, {51.6, -0.5, 0}), 51.19888284557982, 1e-10);
  EXPECT_NEAR(geodesic_azimuth_deg({40.6, -73.8, 0}, {49.01666667, 2.55, 0}), 53.47022, 5e-6);
  EXPECT_NEAR(geodesic_azimuth_deg({-41.32, 174.81, 0}, {40.96, -5.50, 0}), 161.06766998615873,
              1e-10);
  EXPECT_NEAR(geodesic_azimuth_deg({0, 0, 0}, {0, -1, 0}), 270, 1e-12);
}

TEST(Wrapped360, BringsAnglesIntoOneTurn) {
  EXPECT_EQ(wrapped_360(0), 0);
  EXPECT_EQ(wrapped_360(360), 0);
  EXPECT_EQ(wrapped_360(725), 5);
  EXPECT_EQ(wrapped_360(-0.5), 359.5);
  EXPECT_EQ(wrapped_360(-720), 0);
  EXPECT_EQ(wrapped_360(-1e-20), 0);  // 360 - 1e-20 rounds to 360, which is not in the range
}

TEST(IsValid, HoldsPositionsOnTheEarth) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(is_valid({90, 180, -400}));
  EXPECT_TRUE(is_valid({-90, -180, 0}));
  EXPECT_FALSE(is_valid({90.0001, 0, 0}));
  EXPECT_FALSE(is_valid({0, -180.0001, 0}));
  EXPECT_FALSE(is_valid({kNan, 0, 0}));
  EXPECT_FALSE(is_valid({0, kNan, 0}));
  EXPECT_FALSE(is_valid({0, 0, kNan}));
  EXPECT_FALSE(is_valid({0, 0, std::numeric_limits<double>::infinity()}));
}

TEST(LocalFrame, AgreesWithThePublishedExample) {
  // CartConvert's manual, to the centimetre: echo 33.3 44.4 6000 | CartConvert -l 33 44 20
  const EnuPoint enu = LocalFrame({33, 44, 20}).enu_from_geo({33.3, 44.4, 6000});
  EXPECT_NEAR(enu.east_m, 37288.97, 1e-2);
  EXPECT_NEAR(enu.north_m, 33374.29, 1e-2);
  EXPECT_NEAR(enu.up_m, 5783.64, 1e-2);
}

TEST(LocalFrame, HasItsOriginAtZeroAndItsAxesEastNorthUp) {
  const GeoPoint origin{49, 8.4, 110};
  const LocalFrame frame(origin);
  const EnuPoint zero = frame.enu_from_geo(origin);
  EXPECT_NEAR(std::hypot(zero.east_m, zero.north_m, zero.up_m), 0, 1e-9);
  EXPECT_GT(frame.geo_from_enu({1, 0, 0}).longitude_deg, origin.longitude_deg);
  EXPECT_GT(frame.geo_from_enu({0, 1, 0}).latitude_deg, origin.latitude_deg);
  EXPECT_NEAR(frame.geo_from_enu({0, 0, 1}).altitude_m, origin.altitude_m + 1, 1e-8);
}

TEST(LocalFrame, LeadsThereAndBack) {
  for (const GeoPoint& origin : {GeoPoint{49, 8.4, 110}, GeoPoint{-36.7, 179.9999, -20}}) {
    const LocalFrame frame(origin);
    for (const EnuPoint& point : {EnuPoint{0, 0, 0}, EnuPoint{1234.5, -987.6, 54.3},
                                  EnuPoint{-20000, 15000, 300}, EnuPoint{0.001, 0.002, 0.003}}) {
      const EnuPoint back = frame.enu_from_geo(frame.geo_from_enu(point));
      EXPECT_NEAR(back.east_m, point.east_m, 1e-7);
      EXPECT_NEAR(back.north_m, point.north_m, 1e-7);
      EXPECT_NEAR(back.up_m, point.up_m, 1e-7);
    }
  }
}

}  // namespace
}  // namespace milepost
