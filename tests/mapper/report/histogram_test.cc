#include "mapper/report/histogram.h"

#include <gtest/gtest.h>

#include <numeric>

namespace milepost {
namespace {

double sum_of(const Json& values) {
  double sum = 0;
  for (const Json& each : values) sum += each.get<double>();
  return sum;
}

TEST(Histogram, SharesAddUpToAllAlsoThoseBeyond) {
  std::vector<double> values(200, 1.0);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 0.01 * static_cast<double>(i);
  values.push_back(1e6);
  const Figure figure = histogram_figure("h", "c", {"metres", "things"}, {{"a", "m0", values}});
  const Json layer = figure.plots.at(0)["layers"].at(0);
  EXPECT_NEAR(sum_of(layer["y"]), 100, 0.2);
  EXPECT_EQ(layer["x"].size(), layer["y"].size());
  EXPECT_LT(figure.plots[0]["x"]["max"].get<double>(), 3);
  EXPECT_EQ(layer["total"], 201);
}

TEST(Histogram, WholeNumbersHaveABinEach) {
  const Figure figure =
      histogram_figure("h", "c", {"drives", "things", true}, {{"a", "m0", {1, 1, 1, 2}}});
  const Json layer = figure.plots.at(0)["layers"].at(0);
  EXPECT_EQ(layer["x"].dump(), "[0.5,0.5,1.5,2.5,3.5,4.5]");
  EXPECT_EQ(layer["y"].dump(), "[0,75,25,0,0,0]");
}

TEST(Histogram, OfNothingIsEmpty) {
  EXPECT_TRUE(histogram_figure("h", "c", {"m", "things"}, {{"a", "m0", {}}}).plots.empty());
}

TEST(Histogram, OfZerosHasOneBin) {
  const Figure figure = histogram_figure("h", "c", {"m", "things"}, {{"a", "m0", {0, 0}}});
  EXPECT_EQ(figure.plots.at(0)["layers"].at(0)["y"].dump(), "[0,100,0]");
}

}  // namespace
}  // namespace milepost
