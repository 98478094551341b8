#include "mapper/geodata/datum_transform.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace milepost {
namespace {

using ::testing::HasSubstr;

constexpr GeoPoint kKarlsruhe{49.0, 8.4, 120.0};

Result<DatumTransform> between(const std::string& from, const std::string& to) {
  return DatumTransform::between(*Datum::from(from), *Datum::from(to));
}

std::string error_between(const std::string& from, const std::string& to) {
  const auto transform = between(from, to);
  if (!transform) return transform.error().line();
  const auto moved = transform->transformed(kKarlsruhe);
  return moved ? "" : moved.error().line();
}

// Eurasia moves 2.5 cm a year to the north-east, since 1989.
TEST(DatumTransform, EuropeHasMovedInTheFrameOfTheEarth) {
  const auto transform = between("ETRF2000", "ITRF2014@2020.5");
  ASSERT_TRUE(transform.ok()) << transform.error().line();
  const auto moved = transform->transformed(kKarlsruhe);
  ASSERT_TRUE(moved.ok()) << moved.error().line();
  EXPECT_NEAR(geodesic_distance_m(kKarlsruhe, *moved), 0.81, 0.02);
  EXPECT_NEAR(geodesic_azimuth_deg(kKarlsruhe, *moved), 45, 5);
  const auto back = between("ITRF2014@2020.5", "ETRF2000");
  ASSERT_TRUE(back.ok());
  const auto again = back->transformed(*moved);
  ASSERT_TRUE(again.ok());
  EXPECT_LT(geodesic_distance_m(kKarlsruhe, *again), 1e-4);
  EXPECT_NEAR(again->altitude_m, kKarlsruhe.altitude_m, 1e-4);
}

TEST(DatumTransform, WhatCannotBeKnownIsRefused) {
  EXPECT_THAT(error_between("ETRF2000", "ITRF2014"), HasSubstr("needs an epoch"));
  EXPECT_THAT(error_between("ITRF2014@2010", "ITRF2014@2020"), HasSubstr("it is not known how"));
  EXPECT_THAT(error_between("ETRS89", "WGS 84"), HasSubstr("is known to 1 m only"));
  EXPECT_THAT(error_between("Atlantis", "ITRF2014@2020"), HasSubstr("'Atlantis' is no datum"));
  EXPECT_EQ(error_between("ITRF2014@2020.5", "ITRF2020@2020.5"), "");
}

}  // namespace
}  // namespace milepost
