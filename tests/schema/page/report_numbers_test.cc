#include "schema/page/report_numbers.h"

#include <gtest/gtest.h>

#include "schema/page/report_json.h"

namespace milepost {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(ReportJson, NumbersAreRoundedAndUnknownOnesNull) {
  EXPECT_EQ(rounded({0.12345, -2.0, kNaN, kInfinity, -0.0001, 1e300}, 3).dump(),
            "[0.123,-2,null,null,0,1e+300]");
}

TEST(ReportNumbers, AreForReaders) {
  EXPECT_EQ(number(0.256, 2), "0.26");
  EXPECT_EQ(number(-0.256, 2), "\u22120.26");
  EXPECT_EQ(number(-0.001, 2), "0.00");
  EXPECT_EQ(number(kNaN, 2), "\u2013");
  EXPECT_EQ(number(-kInfinity, 2), "\u2013");
  EXPECT_EQ(number(1e300, 2).size(), 304U);
  EXPECT_EQ(signed_number(0.256, 2), "+0.26");
  EXPECT_EQ(signed_number(0.001, 2), "0.00");
  EXPECT_EQ(signed_number(-1, 0), "\u22121");
  EXPECT_EQ(metres(0.0996), "0.10\u00A0m");
  EXPECT_EQ(listed({"a", "b", "c"}), "a, b and c");
}

TEST(ReportNumbers, StepsAreRound) {
  EXPECT_DOUBLE_EQ(round_step(0.011).length, 0.02);
  EXPECT_EQ(round_step(0.011).decimals, 2);
  EXPECT_DOUBLE_EQ(round_step(0.2).length, 0.2);
  EXPECT_DOUBLE_EQ(round_step(6).length, 10);
  EXPECT_EQ(round_step(0.07).decimals, 1);
  EXPECT_DOUBLE_EQ(rounded_up(0.27, 3), 0.3);
  EXPECT_DOUBLE_EQ(rounded_up(30, 4), 30);
  EXPECT_DOUBLE_EQ(rounded_up(kNaN, 4), 1);
  EXPECT_DOUBLE_EQ(rounded_up(0, 4), 1);
}

}  // namespace
}  // namespace milepost
