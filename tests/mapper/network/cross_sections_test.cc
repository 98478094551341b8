#include "mapper/network/cross_sections.h"

#include <gtest/gtest.h>

#include <vector>

namespace milepost {
namespace {

Way way_of(std::size_t drive, std::size_t metres) {
  Way way;
  way.drive = drive;
  way.length_m = static_cast<double>(metres);
  way.states.resize(metres + 1);
  return way;
}

// Way 1 begins some 0.8 m beyond the begin of way 0; they end together.
TEST(CrossSections, PlacesLieOnTheirWays) {
  const std::vector<Way> ways = {way_of(0, 10), way_of(1, 9)};
  Alignment beside{0, 1, 1, {}};
  for (int i = 0; i < 10; ++i) beside.matches.push_back({0.2 + i * 0.98, 1, 0, 0});
  const CrossSections sections(ways, {beside});
  for (double along_m = 0; along_m <= 10; along_m += 0.1) {
    for (const Place& place : sections.places({0, along_m})) {
      EXPECT_GE(place.along_m, 0) << along_m;
      EXPECT_LE(place.along_m, ways[place.way].length_m) << along_m;
    }
  }
  ASSERT_EQ(sections.places({0, 0.6}).size(), 2U);
  EXPECT_EQ(sections.places({0, 0.6}).back().along_m, 0);
  EXPECT_NEAR(sections.places({0, 5}).back().along_m, 0.2 + 4 * 0.98, 1e-9);
}

}  // namespace
}  // namespace milepost
