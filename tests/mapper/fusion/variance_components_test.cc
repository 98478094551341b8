#include "mapper/fusion/variance_components.h"

#include <gtest/gtest.h>

namespace milepost {
namespace {

Squares squares(double position_m2, double values, bool is_stated = false) {
  return {ByKind(position_m2 * values, position_m2 * values), ByKind(values, values), is_stated};
}

TEST(VarianceComponents, FewValuesAreWidenedAsByStudentsT) {
  EXPECT_NEAR(few_values_factor(3), 2.734, 1e-3);  // quantiles of 97.725 %: 3.307 and 2.181
  EXPECT_NEAR(few_values_factor(15), 1.189, 1e-3);
  EXPECT_NEAR(few_values_factor(100000), 1, 1e-3);
}

TEST(VarianceComponents, CommonIsTheMedianOfWhatIsNotStated) {
  const ByKind least(1e-4, 1e-4);
  const ByKind common = common_variances(
      {squares(1, 6), squares(4, 6), squares(9, 6), squares(100, 6, true)}, 2, least);
  EXPECT_DOUBLE_EQ(common[0], 4);
  EXPECT_DOUBLE_EQ(common[1], 6.5);  // nothing is stated of roll
  EXPECT_DOUBLE_EQ(common_variances({squares(1, 6, true)}, 2, least)[0], 2);
  EXPECT_DOUBLE_EQ(common_variances({squares(1e-9, 6)}, 2, least)[0], 1e-4);
}

TEST(VarianceComponents, ADrivesOwnAreDrawnToTheCommonOnes) {
  EXPECT_DOUBLE_EQ(drawn_variances(squares(4, 3), ByKind(1, 1), 3, 25)[0], 2.5);
  EXPECT_DOUBLE_EQ(drawn_variances(squares(4, 3, true), ByKind(1, 1), 3, 25)[0], 25);
  EXPECT_DOUBLE_EQ(drawn_variances(squares(49, 3, true), ByKind(1, 1), 3, 25)[0], 37);
}

}  // namespace
}  // namespace milepost
