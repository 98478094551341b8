#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "client/evaluate/report/plot/axis.h"
#include "client/evaluate/report/plot/chart.h"
#include "client/evaluate/report/plot/text.h"

namespace milepost::plot {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(PlotText, EscapesMarkup) {
  EXPECT_EQ(escaped(R"(<a href="x">Tom & 'Jerry'</a>)"),
            "&lt;a href=&quot;x&quot;&gt;Tom &amp; &#39;Jerry&#39;&lt;/a&gt;");
}

TEST(PlotText, KeepsUtf8) { EXPECT_EQ(escaped("Straße 東 🚗\n"), "Straße 東 🚗\n"); }

TEST(PlotText, ReplacesWhatIsNoTextOfXml) {
  const std::string replaced = "\uFFFD";
  EXPECT_EQ(escaped(std::string_view("\0", 1)), replaced);
  EXPECT_EQ(escaped("\x1B["), replaced + "[");
  EXPECT_EQ(escaped("\x80"), replaced);                                // no lead byte
  EXPECT_EQ(escaped("\xC3"), replaced);                                // cut off
  EXPECT_EQ(escaped("\xC3<"), replaced + "&lt;");                      // does not swallow markup
  EXPECT_EQ(escaped("\xC0\xBC"), replaced + replaced);                 // '<' in two bytes
  EXPECT_EQ(escaped("\xE0\x80\xBC"), replaced + replaced + replaced);  // '<' in three
  EXPECT_EQ(escaped("\xED\xA0\x80"), replaced);                        // a surrogate
  EXPECT_EQ(escaped("\xEF\xBF\xBF"), replaced);                        // U+FFFF
}

TEST(PlotText, NumbersForReaders) {
  EXPECT_EQ(number(0.256, 2), "0.26");
  EXPECT_EQ(number(-0.256, 2), "\u22120.26");
  EXPECT_EQ(number(-0.001, 2), "0.00");
  EXPECT_EQ(number(kNaN, 2), "\u2013");
  EXPECT_EQ(number(-std::numeric_limits<double>::infinity(), 2), "\u2013");
  EXPECT_EQ(signed_number(0.256, 2), "+0.26");
  EXPECT_EQ(signed_number(0.001, 2), "0.00");
  EXPECT_EQ(signed_number(-1, 0), "\u22121");
}

TEST(PlotText, PercentForAttributes) {
  EXPECT_EQ(percent(1.0 / 3), "33.33%");
  EXPECT_EQ(percent(-0.5), "-50.00%");
}

TEST(PlotAxis, ALogarithmicAxisHasTicksAtPowersOfTen) {
  const Axis axis = Axis::logarithmic("error (m)", 0.1, 100);
  EXPECT_THAT(axis.ticks().values, ElementsAre(DoubleNear(0.1, 1e-9), DoubleNear(1, 1e-9),
                                               DoubleNear(10, 1e-9), DoubleNear(100, 1e-9)));
  EXPECT_EQ(axis.tick_text(axis.ticks().values[0]), "0.1");
  EXPECT_EQ(axis.tick_text(axis.ticks().values[3]), "100");
  EXPECT_NEAR(axis.share(1), 1.0 / 3, 1e-9);
  EXPECT_FALSE(std::isfinite(axis.share(0)));
  EXPECT_LT(Axis::logarithmic("", 0, 5).from(), Axis::logarithmic("", 0, 5).to());
  EXPECT_GT(Axis::logarithmic("", kNaN, kNaN).from(), 0);
}

TEST(PlotChart, ASharedShapeIsPlacedInTheUnitsOfTheAxes) {
  Chart chart = Chart::of_equal_units(Axis::spanning("", 10, 30), Axis::spanning("", 0, 10), "");
  chart.shared("ground");
  EXPECT_THAT(chart.svg(), HasSubstr("<use href=\"#ground\" transform=\"matrix(500.000000 0 0 "
                                     "1000.000000 -5000.000000 10000.000000)\"/>"));
}

TEST(PlotAxis, TicksAreRound) {
  const Ticks ticks = round_ticks(-0.13, 0.34, 6);
  EXPECT_DOUBLE_EQ(ticks.step, 0.1);
  EXPECT_EQ(ticks.decimals, 1);
  EXPECT_THAT(ticks.values,
              ElementsAre(DoubleNear(-0.1, 1e-12), DoubleNear(0, 1e-12), DoubleNear(0.1, 1e-12),
                          DoubleNear(0.2, 1e-12), DoubleNear(0.3, 1e-12)));
}

TEST(PlotAxis, TicksMeetTheEndsDespiteRounding) {
  EXPECT_EQ(round_ticks(0, 0.3, 3).values.size(), 4U);
  EXPECT_EQ(round_ticks(0, 300, 6).step, 50);
  EXPECT_EQ(round_ticks(0, 300, 6).decimals, 0);
}

TEST(PlotAxis, RoundedEndsAreTicks) {
  const Axis axis = Axis::rounded("error (m)", -0.27, 0.27);
  EXPECT_DOUBLE_EQ(axis.from(), -0.3);
  EXPECT_DOUBLE_EQ(axis.to(), 0.3);
  EXPECT_NEAR(axis.ticks().values.front(), -0.3, 1e-12);
}

TEST(PlotAxis, CanBeDrawnFromAnyEnds) {
  for (const auto& [from, to] :
       std::vector<std::pair<double, double>>{{5, 5},
                                              {0, 0},
                                              {kNaN, kNaN},
                                              {0, kNaN},
                                              {3, 2},
                                              {1e15, 1e15},
                                              {0, std::numeric_limits<double>::infinity()}}) {
    for (const Axis& axis : {Axis::spanning("x", from, to), Axis::rounded("x", from, to)}) {
      EXPECT_LT(axis.from(), axis.to());
      EXPECT_TRUE(std::isfinite(axis.share(1)));
      EXPECT_FALSE(axis.ticks().values.empty());
      EXPECT_LT(axis.ticks().values.size(), 20U);
    }
  }
}

TEST(PlotAxis, ZeroLengthHasItsValueInTheMiddle) {
  EXPECT_DOUBLE_EQ(Axis::spanning("x", 5, 5).share(5), 0.5);
}

Chart small_chart() {
  return Chart::of_height(Axis::spanning("x (m)", 0, 10), Axis::spanning("y <m>", 0, 1), 100,
                          "a & b");
}

TEST(PlotChart, AGapBreaksTheLineAndALonePointIsADot) {
  Chart chart = small_chart();
  chart.line({{0, 0}, {5, 1}, {6, kNaN}, {8, 0.5}}, "line");
  EXPECT_THAT(chart.svg(), HasSubstr("d=\"M0 10000L5000 0M8000 5000h1\""));
}

TEST(PlotChart, ALineOfGapsIsNotDrawn) {
  Chart chart = small_chart();
  chart.line({{0, kNaN}, {kNaN, 1}}, "line");
  EXPECT_THAT(chart.svg(), Not(HasSubstr("<path")));
}

TEST(PlotChart, TheBandLiesOnBothSidesOfZero) {
  Chart chart = Chart::of_height(Axis::spanning("x", 0, 1), Axis::spanning("y", -1, 1), 100, "");
  chart.band({{0, 0.5}, {1, 1}}, "band");
  EXPECT_THAT(chart.svg(), HasSubstr("d=\"M0 2500L10000 0 10000 10000 0 7500z\""));
}

TEST(PlotChart, FarPointsKeepTheirNumbersSmall) {
  Chart chart = small_chart();
  chart.line({{0, 1e300}, {10, -1e300}}, "line");
  EXPECT_THAT(chart.svg(), HasSubstr("d=\"M0 -10000L10000 20000\""));
}

TEST(PlotChart, ArrowsStandForPointsBeyondTheEdge) {
  Chart chart = small_chart();
  chart.arrows_beyond({{1, 2}, {2, -1}, {3, 0.5}, {4, kNaN}}, "m0");
  EXPECT_THAT(chart.svg(), HasSubstr("<use href=\"#up\" class=\"m0\" x=\"10.00%\" y=\"0\"/>"));
  EXPECT_THAT(chart.svg(), HasSubstr("<use href=\"#down\" class=\"m0\" x=\"20.00%\" y=\"100%\"/>"));
  EXPECT_THAT(chart.svg(), Not(HasSubstr("x=\"30.00%\" y=\"0\"")));
}

TEST(PlotChart, CirclesOutsideThePlotAreNotDrawn) {
  Chart chart = small_chart();
  chart.circle({11, 0.5}, 3, "dot", "outside");
  chart.circle({5, 0.5}, 3, "dot", "<inside>");
  EXPECT_THAT(chart.svg(), Not(HasSubstr("outside")));
  EXPECT_THAT(chart.svg(), HasSubstr("cx=\"50.00%\" cy=\"50.00%\"><title>&lt;inside&gt;</title>"));
}

TEST(PlotChart, LabelsAreEscaped) {
  EXPECT_THAT(small_chart().svg(), HasSubstr(">y &lt;m&gt;<"));
  EXPECT_THAT(small_chart().svg(), HasSubstr("aria-label=\"a &amp; b\""));
}

TEST(PlotChart, ALaneMarkOfOnePointIsAsLongAsItsEnds) {
  Chart chart = small_chart();
  chart.add_lane("m0");
  chart.mark_lane(5, 5, "s-lost", "lost");
  EXPECT_THAT(chart.svg(), HasSubstr("class=\"s-lost\" d=\"M5000 14H5001\"><title>lost</title>"));
}

TEST(PlotChart, ALaneWithoutAClassHasNoHead) {
  Chart chart = small_chart();
  chart.add_lane("");
  EXPECT_THAT(chart.svg(), Not(HasSubstr("<circle")));
  chart.mark_lane(5, 5, "s-lost", "");
  EXPECT_THAT(chart.svg(), HasSubstr("M5000 14H5001"));
  chart.add_lane("m1");
  EXPECT_THAT(chart.svg(), HasSubstr("<circle class=\"m1\" cx=\"-10\" cy=\"23\" r=\"3\"/>"));
}

TEST(PlotChart, ASymbolKeepsItsDistanceFromItsPoint) {
  Chart chart = small_chart();
  chart.symbol({10, 0}, -20, 40.4, "casing", "north");
  EXPECT_THAT(chart.svg(), HasSubstr("<use href=\"#north\" class=\"casing\" x=\"100.00%\" "));
  EXPECT_THAT(chart.svg(), HasSubstr("transform=\"translate(-20 40)\"/>"));
  EXPECT_THAT(Chart::definitions(), HasSubstr("id=\"north\""));
  chart.symbol({kNaN, 0}, 0, 0, "north", "north");
  EXPECT_THAT(chart.svg(), Not(HasSubstr("class=\"north\"")));
}

}  // namespace
}  // namespace milepost::plot
