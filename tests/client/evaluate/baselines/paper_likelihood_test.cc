// The evidence of frames for methods without a model of "elsewhere".
#include "client/evaluate/baselines/paper_likelihood.h"

#include <gtest/gtest.h>

namespace milepost {
namespace {

constexpr double kFull = PaperLikelihood::kLogBayesFactor;

PaperLikelihood on_a_road(int matches) {
  PaperLikelihood likelihood;
  for (int frame = 0; frame < 20; ++frame) likelihood.of_frame(true, matches);
  return likelihood;
}

TEST(PaperLikelihood, TheFirstFramesCountAndLaterOnesHardly) {
  PaperLikelihood likelihood;
  for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(likelihood.of_frame(true, 5), kFull);
  EXPECT_EQ(likelihood.of_frame(true, 100), 1);
  EXPECT_EQ(likelihood.of_frame(false, 0), 0);
  EXPECT_EQ(likelihood.of_frame(true, 100), kFull);
}

TEST(PaperLikelihood, BeyondAJunctionFewMatchesSpeakAgainstTheBranch) {
  PaperLikelihood right = on_a_road(60);
  right.pass_junction();
  EXPECT_GT(right.of_frame(true, 55), 4);
  EXPECT_NEAR(right.of_frame(true, 15), 0, 0.1);
  PaperLikelihood wrong = on_a_road(60);
  wrong.pass_junction();
  for (int frame = 0; frame < 30; ++frame) EXPECT_LT(wrong.of_frame(true, 5), -1.5) << frame;
  EXPECT_LT(wrong.of_frame(false, 0), -2);
}

TEST(PaperLikelihood, FarBeyondAJunctionFramesCountAsBefore) {
  PaperLikelihood likelihood = on_a_road(60);
  likelihood.pass_junction();
  for (int frame = 0; frame < 40; ++frame) likelihood.of_frame(true, 60);
  EXPECT_EQ(likelihood.of_frame(true, 60), 1);
}

TEST(PaperLikelihood, WithoutMatchesAJunctionChangesNothing) {
  PaperLikelihood likelihood = on_a_road(0);
  likelihood.pass_junction();
  EXPECT_EQ(likelihood.of_frame(true, 0), 1);
}

}  // namespace
}  // namespace milepost
