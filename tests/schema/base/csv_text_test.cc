#include "schema/base/csv_text.h"

#include <gtest/gtest.h>

namespace milepost {
namespace {

TEST(Digits, AreTheSameNumberAgainAsShortAsTheirTypeAllows) {
  EXPECT_EQ(shortest(0.1), "0.1");
  EXPECT_EQ(shortest(1e20), "1e+20");
  EXPECT_EQ(shortest_fixed(1e20), "100000000000000000000");
  EXPECT_EQ(shortest_fixed(0.04F), "0.04");
}

TEST(Digits, AreRoundedToDecimals) {
  EXPECT_EQ(fixed(2.0 / 3, 3), "0.667");
  EXPECT_EQ(fixed(-1, 2), "-1.00");
  EXPECT_EQ(fixed(0.5, 90), "0.50000000000000000000");
  EXPECT_EQ(fixed(-1e308, 0).size(), 310U);
}

TEST(CsvText, HasOneLineARow) {
  CsvText csv("time_s,name,count,value");
  csv.exact(0.25).cell("a").cell(static_cast<long long>(3)).rounded(1.26, 1).end_row();
  csv.rounded(std::nullopt, 2).cell("").cell(static_cast<long long>(-1));
  csv.rounded(std::optional(2.0), 2).end_row();
  EXPECT_EQ(csv.text(), "time_s,name,count,value\n0.25,a,3,1.3\n,,-1,2.00\n");
}

}  // namespace
}  // namespace milepost
