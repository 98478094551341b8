#include "mapper/report/stretch_views.h"

#include <gmock/gmock.h>

namespace milepost {
namespace {

using ::testing::ElementsAre;
using ::testing::Eq;

StretchFit fit(std::uint64_t followed, std::uint64_t fitting) {
  StretchFit made;
  made.fit.followed = followed;
  made.fit.fitting = fitting;
  return made;
}

TEST(StretchViews, EachHasFiveClassesFromGoodToBad) {
  ASSERT_EQ(stretch_views().size(), 5U);
  for (const StretchView& view : stretch_views()) EXPECT_EQ(view.classes.size(), 5U) << view.name;
  const std::vector<ViewClass>& world = stretch_views()[0].classes;
  EXPECT_EQ(world.front().words, "up to 0.05 m");
  EXPECT_EQ(world.back().words, "more than 0.5 m");
  EXPECT_EQ(stretch_views()[4].classes.back().words, "less than 50 %");
}

TEST(StretchViews, ALimitBelongsToTheBetterClass) {
  const auto world = [](double sigma_m) {
    StretchValues values;
    values.sigma_world_m = sigma_m;
    return classes_of(values)[0];
  };
  EXPECT_EQ(world(0.05), 0);
  EXPECT_EQ(world(0.051), 1);
  EXPECT_EQ(world(0.6), 4);
  StretchValues values;
  values.passes = 8;
  EXPECT_EQ(classes_of(values)[3], 0);
  values.passes = 7;
  EXPECT_EQ(classes_of(values)[3], 1);
  values.passes = 1;
  EXPECT_EQ(classes_of(values)[3], 4);
}

TEST(StretchViews, WithoutAValueThereIsNoClass) {
  EXPECT_THAT(classes_of({}), ElementsAre(Eq(std::nullopt), Eq(std::nullopt), Eq(std::nullopt),
                                          Eq(std::nullopt), Eq(std::nullopt)));
}

TEST(StretchValues, TheFitIsThatOfAllDrives) {
  MapStretch stretch;
  stretch.along = {0, 10};
  EXPECT_FALSE(values_of(stretch, 1).fit_percent);
  stretch.fits = {fit(100, 90), fit(300, 150), fit(0, 0)};
  EXPECT_DOUBLE_EQ(*values_of(stretch, 1).fit_percent, 60);
  EXPECT_FALSE(values_of(stretch, 0).passes);
}

}  // namespace
}  // namespace milepost
