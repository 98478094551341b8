#include "mapper/geodata/coordinate_transform.h"

#include <gtest/gtest.h>

namespace milepost {
namespace {

TEST(CoordinateTransform, DegreesAreOfTheSystemsOwnDatum) {
  const auto utm = CoordinateTransform::from("EPSG:25832");
  ASSERT_TRUE(utm.ok()) << utm.error().line();
  EXPECT_EQ(utm->datum(), "ETRS89");
  const auto at = utm->geographic_of(500000, 0, 12);  // on the zone's meridian and the equator
  ASSERT_TRUE(at.ok());
  EXPECT_NEAR(at->latitude_deg, 0, 1e-9);
  EXPECT_NEAR(at->longitude_deg, 9, 1e-9);
  EXPECT_NEAR(at->altitude_m, 12, 1e-6);
  EXPECT_FALSE(utm->is_geocentric());
}

TEST(CoordinateTransform, GeocentricCoordinatesHaveHeights) {
  const auto geocentric = CoordinateTransform::from("EPSG:4978");
  ASSERT_TRUE(geocentric.ok());
  EXPECT_TRUE(geocentric->is_geocentric());
  const auto at = geocentric->geographic_of(6378137 + 25, 0, 0);
  ASSERT_TRUE(at.ok());
  EXPECT_NEAR(at->altitude_m, 25, 1e-6);
}

// Degrees on Airy's ellipsoid would be hundreds of metres off on that of WGS84.
TEST(CoordinateTransform, AnotherEllipsoidIsLeft) {
  const auto grid = CoordinateTransform::from("EPSG:27700");
  ASSERT_TRUE(grid.ok());
  EXPECT_EQ(grid->datum(), "WGS 84");
  const auto greenwich = grid->geographic_of(538874, 177344, 0);
  ASSERT_TRUE(greenwich.ok());
  EXPECT_NEAR(greenwich->longitude_deg, -0.0015, 0.001);  // beside the meridian of old by 100 m
}

TEST(CoordinateTransform, WhatIsNoSystemIsRefused) {
  EXPECT_FALSE(CoordinateTransform::from("EPSG:1").ok());
  EXPECT_FALSE(CoordinateTransform::from("").ok());
  EXPECT_FALSE(CoordinateTransform::from("EPSG:25832")->geographic_of(1e12, 1e12, 0).ok());
}

}  // namespace
}  // namespace milepost
