#include "client/fetch/nearby.h"

#include <gtest/gtest.h>

namespace milepost::testing {
namespace {

const MapVersion kVersion{"town", "build"};

SegmentDescription meridian(const std::string& id, double longitude_deg) {
  return {id, 111.2, {{49, longitude_deg, 0}, {49.001, longitude_deg, 0}}, {}};
}

TEST(LinesNear, NearestFirstAndNoneBeyondTheRadius) {
  std::vector<KnownLine> lines;
  add_line(kVersion, meridian("far", 8.4010), lines);    // 73 m to the east
  add_line(kVersion, meridian("near", 8.4001), lines);   // 7 m
  add_line(kVersion, meridian("other", 8.3997), lines);  // 22 m to the west
  const auto found = lines_near(lines, {49.0005, 8.4, 0}, 30);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].segment, "near");
  EXPECT_NEAR(found[0].distance_m, 7.3, 0.1);
  EXPECT_NEAR(found[0].along_m, 55.6, 0.1);
  EXPECT_EQ(found[0].length_m, 111.2);
  EXPECT_EQ(found[1].segment, "other");
}

TEST(LinesNear, EqualDistancesAreInTheOrderOfTheNames) {
  std::vector<KnownLine> lines;
  add_line(kVersion, meridian("b", 8.4), lines);
  add_line(kVersion, meridian("a", 8.4), lines);
  const auto found = lines_near(lines, {49.0005, 8.4, 0}, 30);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].segment, "a");
}

TEST(LinesNear, ASegmentWithoutALineIsNeverNear) {
  std::vector<KnownLine> lines;
  add_line(kVersion, {"point", 0, {{49, 8.4, 0}}, {}}, lines);
  add_line(kVersion, {"nothing", 0, {}, {}}, lines);
  EXPECT_TRUE(lines.empty());
}

}  // namespace
}  // namespace milepost::testing
