#include "client/evaluate/baselines/orientation_filter.h"

#include "client/global/wall_particle_filter.h"
#include "tests/client/global/plan_drive.h"

namespace milepost {
namespace {

using testing::kStepM;
using testing::kStepS;
using testing::Step;

const MakePlanFilter kMake = orientations_method().make_filter;

class OrientationFilterTest : public testing::PlanDriveTest {};

TEST_F(OrientationFilterTest, KeepsAStartThatIsKnown) {
  drive_round_the_corner();
  FilterSettings settings = seeded(1);
  settings.start = StartBelief{{{1, 3}, 0}, 2, 0.1};
  const Outcome outcome = run(kMake, settings, walls_);
  EXPECT_LT(outcome.last_error_m, 15);
}

TEST_F(OrientationFilterTest, SurvivesMeasurementsThatNoParticleExplains) {
  FilterSettings settings = seeded(1);
  const RayCastingGrid far({{{500, 0}, {500, 100}, 0.1}});
  const auto filter = kMake(far, {{-50, -50}, {50, 50}}, settings);
  const WallObservation sight{{{{-0.1, 0.1}, {0.5}}}, {}};
  const PlanEstimate found = filter->update(sight, {kStepS, kStepM, 0});
  EXPECT_GT(found.mode.probability, 0);
  EXPECT_LE(found.mode.probability, 1);
  EXPECT_EQ(filter->particles().size(), settings.particles);
  for (const Particle& particle : filter->particles()) EXPECT_GT(particle.weight, 0);
}

// Section IV: each frame resamples particles by their importance.
TEST_F(OrientationFilterTest, DrawsParticlesAfterEachFrame) {
  drive(10);
  FilterSettings settings = seeded(1);
  const auto filter = kMake(walls_, walls_.bounds(), settings);
  for (const Step& step : steps_) {
    filter->update(step.observation, step.motion);
    EXPECT_EQ(filter->particles().size(), settings.particles);
    EXPECT_NEAR(effective_count(filter->particles()), 2000, 1e-6);
  }
}

TEST_F(OrientationFilterTest, WithoutMeasurementsTheBeliefSpreads) {
  const RayCastingGrid far({{{500, 0}, {500, 100}, 0.1}});
  const PlanBox area{{-600, -600}, {600, 600}};
  FilterSettings settings = seeded(1);
  settings.start = StartBelief{{{0, 0}, 0}, 0.01, 0.001};
  const auto filter = kMake(far, area, settings);
  PlanEstimate found;
  for (int i = 0; i < 60; ++i) found = filter->update({}, {kStepS, kStepM, 0});
  EXPECT_NEAR(found.mode.pose.enu_m.y(), 90, 4);
  EXPECT_GT(found.mode.sigma_m, 0.2);
  EXPECT_GT(found.mode.heading_sigma_rad, 0.01);
}

TEST_F(OrientationFilterTest, WithoutMeasurementsTheInlierRatioStays) {
  drive(10);
  FilterSettings settings = seeded(1);
  settings.start = StartBelief{{{1, 3}, 0}, 1, 0.1};
  const auto filter = kMake(walls_, walls_.bounds(), settings);
  PlanEstimate found;
  for (const Step& step : steps_) found = filter->update(step.observation, step.motion);
  EXPECT_GT(found.inlier_ratio, 0.1);
  EXPECT_EQ(filter->update({}, {kStepS, kStepM, 0}).inlier_ratio, found.inlier_ratio);
}

// Its odometry noise of rotation is 5 degrees per square root of a second; ours is one degree.
TEST_F(OrientationFilterTest, IsLessSureOfTurns) {
  FilterSettings settings = seeded(1);
  settings.start = StartBelief{{{1, 3}, 0}, 1, 0.002};
  const auto heading_sigma_rad = [&](const MakePlanFilter& make_filter) {
    const auto filter = make_filter(walls_, walls_.bounds(), settings);
    return filter->update({}, {4, 16, 0}).mode.heading_sigma_rad;
  };
  EXPECT_GT(heading_sigma_rad(kMake), 2 * heading_sigma_rad(combined_method().make_filter));
}

}  // namespace
}  // namespace milepost
