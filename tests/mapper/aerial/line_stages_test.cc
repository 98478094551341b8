// The stages with lines as input: blocks, merging, closure, corners, coverage.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "mapper/aerial/block_plan.h"
#include "mapper/aerial/closure.h"
#include "mapper/aerial/corners.h"
#include "mapper/aerial/coverage.h"
#include "mapper/aerial/line_grid.h"
#include "mapper/aerial/merging.h"

namespace milepost {
namespace {

WallLine line(double x1, double y1, double x2, double y2) { return {{x1, y1}, {x2, y2}}; }

void expect_line(const WallLine& found, const WallLine& wanted, double within_m = 1e-6) {
  EXPECT_LT((found.begin_m - wanted.begin_m).norm(), within_m) << found.begin_m.transpose();
  EXPECT_LT((found.end_m - wanted.end_m).norm(), within_m) << found.end_m.transpose();
}

TEST(BlockPlan, CoresCoverTheImageOnceAndMarginsStayInIt) {
  const cv::Size image(1030, 410);
  cv::Mat covered = cv::Mat::zeros(image, CV_8UC1);
  for (const Block& block : blocks_of(image, 200, 30)) {
    covered(block.core) += 1;
    EXPECT_EQ(block.seen & cv::Rect({0, 0}, image), block.seen);
    EXPECT_EQ(block.core & block.seen, block.core);
    EXPECT_EQ(block.seen.tl(),
              cv::Point(std::max(0, block.core.x - 30), std::max(0, block.core.y - 30)));
    EXPECT_EQ(block.seen.br(), cv::Point(std::min(1030, block.core.br().x + 30),
                                         std::min(410, block.core.br().y + 30)));
  }
  EXPECT_EQ(cv::countNonZero(covered != 1), 0);
}

TEST(BlockPlan, LinesAreCutAtTheBox) {
  const GroundBox box{0, 0, 10, 10};
  const WallLines parts = clipped({line(-5, 5, 15, 5), line(2, 2, 3, 3), line(-1, -5, -1, 5),
                                   line(5, 12, 5, 8), line(8, 12, 12, 8)},
                                  box);
  ASSERT_EQ(parts.size(), 3U);
  expect_line(parts[0], line(0, 5, 10, 5));
  expect_line(parts[1], line(2, 2, 3, 3));
  expect_line(parts[2], line(5, 10, 5, 8));
}

TEST(LineGrid, FindsWhatIsNearAndNotWhatIsFar) {
  LineGrid grid(2);
  grid.add(0, line(0, 0, 30, 0));
  grid.add(1, line(0, 50, 30, 50));
  grid.add(2, line(0, 0.5, 30, 0.5));  // in the cells of the first
  EXPECT_EQ(grid.near(line(29, 1, 29, 1)), (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(grid.near(line(29, 1, 29, 49)), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(grid.near(line(60, 20, 70, 20)).empty());
}

// The distance between two lines, from points of the first.
double apart_m(const WallLine& a, const WallLine& b) {
  double least_m = (a.begin_m - b.begin_m).norm();
  for (int i = 0; i <= 200; ++i) {
    const Eigen::Vector2d at_m = a.begin_m + i / 200.0 * (a.end_m - a.begin_m);
    const double along_m = direction_of(b).dot(at_m - b.begin_m);
    const double part = std::clamp(along_m / b.length_m(), 0.0, 1.0);
    least_m = std::min(least_m, (at_m - b.begin_m - part * (b.end_m - b.begin_m)).norm());
  }
  return least_m;
}

TEST(LineGrid, MissesNoneWithinACellsWidth) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-40, 40);
  std::uniform_real_distribution<double> way(-1, 1);
  WallLines lines;
  lines.reserve(300);
  for (int i = 0; i < 300; ++i) {
    const double x = place(random);
    const double y = place(random);
    const double reach = i % 3 == 0 ? 60 : 1;  // long ones and short ones
    lines.push_back(line(x, y, x + reach * way(random), y + reach * way(random)));
  }
  constexpr double kCellM = 1.5;
  LineGrid grid(kCellM);
  for (std::size_t i = 0; i < lines.size(); ++i) grid.add(i, lines[i]);
  std::size_t far = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::vector<std::size_t> near = grid.near(lines[i]);
    for (std::size_t j = 0; j < lines.size(); ++j) {
      const bool is_named = std::binary_search(near.begin(), near.end(), j);
      const double away_m = apart_m(lines[i], lines[j]);
      EXPECT_TRUE(is_named || away_m > kCellM) << i << " and " << j << ", " << away_m;
      far += is_named && away_m > 5 * kCellM ? 1 : 0;
    }
  }
  EXPECT_EQ(far, 0U);
}

TEST(Merging, PiecesOfOneLineBecomeOne) {
  const WallLines lines = merged({line(0, 0, 4, 0.1), line(4.5, 0.1, 9, 0), line(0, 5, 3, 5)}, {});
  ASSERT_EQ(lines.size(), 2U);
  expect_line(lines[0], line(0, 0.05, 9, 0.05), 0.1);
  expect_line(lines[1], line(0, 5, 3, 5));
}

TEST(Merging, TheLineIsThatOfLeastSquares) {
  const WallLines beside = merged({line(100, 50, 110, 50), line(102.5, 50.3, 107.5, 50.3)}, {});
  ASSERT_EQ(beside.size(), 1U);
  expect_line(beside[0], line(100, 50.1, 110, 50.1));
  const WallLines turned = merged({line(-5, 0, 5, 0), line(-2.5, -0.2, 2.5, 0.2)}, {});
  ASSERT_EQ(turned.size(), 1U);
  EXPECT_NEAR(direction_of(turned[0]).y(), 125.0 / 1125 * 0.08, 2e-4);  // by their cubed lengths
  const WallLines steps = merged({line(0, 0, 4, 0), line(4.5, 0.3, 8.5, 0.3)}, {});
  ASSERT_EQ(steps.size(), 1U);
  const double slope = 2.25 * 0.15 / (2.25 * 2.25 + 16.0 / 12);
  EXPECT_NEAR(direction_of(steps[0]).y() / direction_of(steps[0]).x(), slope, 2e-4);
}

TEST(Merging, TheLineReachesFromTheFirstEndToTheLast) {
  for (const WallLine& other : {line(8, 0, 6, 0), line(6, 0, 8, 0)}) {
    const WallLines lines = merged({line(0, 0, 5.5, 0), other}, {});
    ASSERT_EQ(lines.size(), 1U);
    expect_line(lines[0], line(0, 0, 8, 0));
  }
}

// A piece that is too far from the longest is near enough to what has been merged with it.
TEST(Merging, GoesOnAsLongAsItGrows) {
  const WallLines lines =
      merged({line(0, 0, 10, 0), line(12, 0, 15, 0), line(10.5, 0, 11.5, 0)}, {});
  ASSERT_EQ(lines.size(), 1U);
  expect_line(lines[0], line(0, 0, 15, 0));
}

TEST(Merging, TheLongestComesFirst) {
  const WallLines lines = merged({line(0, 0, 6, 0), line(0, 9, 5, 9), line(5.5, 9, 10, 9)}, {});
  ASSERT_EQ(lines.size(), 2U);
  expect_line(lines[0], line(0, 9, 10, 9));
}

TEST(Merging, TheLongestPartTellsTheSense) {
  const WallLines lines = merged({line(0, 0, 2, 0), line(9, 0.05, 2.3, 0.05)}, {});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_GT(lines[0].begin_m.x(), lines[0].end_m.x());
}

TEST(Merging, ParallelsApartAndCrossingLinesStay) {
  EXPECT_EQ(merged({line(0, 0, 9, 0), line(0, 0.6, 9, 0.6)}, {}).size(), 2U);
  EXPECT_EQ(merged({line(0, 0, 9, 0), line(0, 0, 9, 2)}, {}).size(), 2U);
  EXPECT_EQ(merged({line(0, 0, 4, 0), line(5.5, 0, 9, 0)}, {}).size(), 2U);
  EXPECT_EQ(merged({line(0, 0, 4, 0), line(-4.5, 0, -1.5, 0)}, {}).size(), 2U);
  EXPECT_EQ(merged({line(0, 0, 9, 0), line(4, -0.2, 4.1, 0.2)}, {}).size(), 2U);
  EXPECT_EQ(merged({line(0, 0, 9, 0), line(1, 0.2, 9, 0.8)}, {}).size(), 2U);
  EXPECT_EQ(merged({line(0, 0, 9, 0), line(1, 0.8, 9, 0.2)}, {}).size(), 2U);
}

TEST(Merging, DoesNotDependOnTheOrder) {
  WallLines lines = {line(0, 0, 4, 0.1), line(4.5, 0.1, 9, 0), line(9.2, 0, 12, 0.1),
                     line(0, 5, 3, 5), line(3.5, 5.1, 6, 5)};
  const WallLines once = merged(lines, {});
  std::reverse(lines.begin(), lines.end());
  const WallLines again = merged(lines, {});
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i) expect_line(again[i], once[i], 1e-9);
}

TEST(Closure, AHouseStandsAndALoneLineDoesNot) {
  const WallLines house = {line(0, 0, 10, 0), line(10, 0.5, 10, 8), line(10, 8, 0, 8),
                           line(0, 8, 0, 0)};
  WallLines lines = house;
  lines.insert(lines.begin() + 2, line(30, 0, 40, 0));
  const WallLines left = closed(lines, {});
  ASSERT_EQ(left.size(), house.size());
  for (std::size_t i = 0; i < house.size(); ++i) expect_line(left[i], house[i]);
}

TEST(Closure, EndsWithinReachAreOfOneCorner) {
  const auto apart = [](double apart_m) {
    return closed({line(0, 0, 10, 0), line(10 + apart_m, 0, 10 + apart_m, 8)}, {}).size();
  };
  EXPECT_EQ(apart(2.4), 2U);
  EXPECT_EQ(apart(2.6), 0U);
}

TEST(Closure, GoesOnUntilAllThatIsLeftStands) {
  ClosureSettings both_ends;
  both_ends.min_ends = 2;
  const WallLines chain = {line(10, 0, 10, 10), line(0, 0, 10, 0), line(10, 10, 20, 10)};
  EXPECT_EQ(closed(chain, {}).size(), 3U);
  EXPECT_TRUE(closed(chain, both_ends).empty());
}

TEST(Corners, EndsAreLedTogether) {
  const WallLines lines = with_corners({line(0, 0, 9, 0), line(10, 1, 10, 8)}, {});
  expect_line(lines[0], line(0, 0, 10, 0));
  expect_line(lines[1], line(10, 0, 10, 8));
}

TEST(Corners, OfAHouseAllAreLedTogether) {
  const WallLines house =
      with_corners({line(1, 0, 9, 0), line(10, 1, 10, 7), line(9, 8, 1, 8), line(0, 7, 0, 1)}, {});
  expect_line(house[0], line(0, 0, 10, 0));
  expect_line(house[1], line(10, 0, 10, 8));
  expect_line(house[2], line(10, 8, 0, 8));
  expect_line(house[3], line(0, 8, 0, 0));
}

TEST(Corners, NeedNotBeSquare) {
  const WallLines lines = with_corners({line(0, 0, 9, 0), line(10.5, 0.5, 18, 8)}, {});
  expect_line(lines[0], line(0, 0, 10, 0));
  expect_line(lines[1], line(10, 0, 18, 8));
}

TEST(Corners, WhatIsFarOrAlmostParallelStays) {
  const WallLines far = {line(0, 0, 7, 0), line(10, 1, 10, 8)};
  expect_line(with_corners(far, {})[0], far[0]);
  const WallLines far_beside = {line(10, 1, 10, 8), line(0, 0, 7, 0)};
  expect_line(with_corners(far_beside, {})[0], far_beside[0]);
  const WallLines flat = {line(0, 0, 9, 0), line(10.5, 0.1, 19, 1.8)};  // they cross at 10, 0
  expect_line(with_corners(flat, {})[0], flat[0]);
  expect_line(with_corners(flat, {})[1], flat[1]);
}

// Moved to the corner, the short line would be reversed.
TEST(Corners, NoLineTurnsRound) {
  const WallLines lines = {line(0, 0, 9, 0), line(8, -0.5, 8, 1)};
  expect_line(with_corners(lines, {})[1], line(8, 0, 8, 1));
  const WallLines shorter = {line(0, 0, 9, 0), line(8, -0.5, 8, 0.1)};
  expect_line(with_corners(shorter, {})[1], line(8, -0.5, 8, 0));
  const WallLines beyond = {line(0, 0, 9, 0), line(8, 0.5, 8, 0.9)};
  expect_line(with_corners(beyond, {})[1], beyond[1]);
}

TEST(Corners, AnEndGoesToTheNearestCornerOnly) {
  const WallLines lines =
      with_corners({line(0, 0, 9, 0), line(9.5, 0.5, 9.5, 8), line(10.5, 0.5, 10.5, 8)}, {});
  EXPECT_NEAR(lines[0].end_m.x(), 9.5, 1e-9);
  expect_line(lines[2], line(10.5, 0.5, 10.5, 8));
  const WallLines turned =
      with_corners({line(0, 0, 9, 0), line(10.5, 0.5, 10.5, 8), line(9.5, 0.5, 9.5, 8)}, {});
  EXPECT_NEAR(turned[0].end_m.x(), 9.5, 1e-9);
  expect_line(turned[1], line(10.5, 0.5, 10.5, 8));
  // ... the other way round: two lines that end at one.
  const WallLines ended =
      with_corners({line(0, 0.9, 9, 0.9), line(0, 0, 9, 0), line(10, -1, 10, -9)}, {});
  expect_line(ended[0], line(0, 0.9, 9, 0.9));
  expect_line(ended[2], line(10, 0, 10, -9));
}

// Half of its length is enough, at any position.
TEST(Coverage, WhatIsKnownForTheGreaterPartIsLeftOut) {
  const WallLines at_both_ends = {line(0, 0, 2, 0), line(8, 0, 10, 0)};
  EXPECT_TRUE(not_covered({line(0, 1, 10, 1)}, at_both_ends, {}).empty());
  const WallLines in_the_middle = {line(4.5, 0, 5.5, 0)};
  EXPECT_EQ(not_covered({line(0, 1, 10, 1)}, in_the_middle, {}).size(), 1U);
}

TEST(Coverage, WhatIsKnownIsLeftOut) {
  const WallLines known = {line(0, 0, 10, 0)};
  const WallLines lines = {line(1, 1, 9, 1.2), line(8, 0.5, 18, 0.5), line(5, -1, 5, 1),
                           line(0, 3, 10, 3)};
  const WallLines others = not_covered(lines, known, {});
  ASSERT_EQ(others.size(), 3U);
  expect_line(others[0], lines[1]);
  expect_line(others[1], lines[2]);
  expect_line(others[2], lines[3]);
}

}  // namespace
}  // namespace milepost
