#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "client/evaluate/baselines/along_filter.h"
#include "client/evaluate/baselines/arc_length_tracker.h"

namespace milepost {
namespace {

constexpr std::size_t kParticles = 4000;

// A vehicle at constant speed, disturbed and measured with Gaussian noise: the Kalman filter is
// exact, and particles differ from it by sampling only. A mean of n samples is off by sigma /
// sqrt(n), a variance by sqrt(2 / n) of itself; weights reduce the effective number of samples, and
// a part of a frame's error carries over to the next, so twice that is allowed over all frames.
TEST(ParticleFilter, IsTheKalmanFilterOnALinearGaussianCase) {
  constexpr int kFrames = 400;
  const double step_m = 2;
  const double sigma_w_m = 0.5;
  const auto kalman = make_kalman_filter();
  const auto particles = make_particle_filter(kParticles, 7);
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 1);
  double truth_m = 100;
  for (auto* filter : {kalman.get(), particles.get()}) filter->reset({truth_m, 0.16});
  double bias = 0;
  double mean_square = 0;
  double variance_square = 0;
  for (int k = 0; k < kFrames; ++k) {
    truth_m += step_m + sigma_w_m * noise(random);
    const Measurement measured{truth_m + 0.8 * noise(random), 1.6, 20};
    for (auto* filter : {kalman.get(), particles.get()}) {
      filter->predict(step_m, sigma_w_m);
      filter->update(measured, 0.25);  // of a variance of 1.6^2: that of the noise
    }
    const AlongBelief exact = kalman->belief();
    const AlongBelief sampled = particles->belief();
    const double off = (sampled.along_m - exact.along_m) / std::sqrt(exact.variance_m2);
    bias += off / kFrames;
    mean_square += off * off / kFrames;
    variance_square += std::pow(sampled.variance_m2 / exact.variance_m2 - 1, 2) / kFrames;
  }
  const double mean_error = 1 / std::sqrt(static_cast<double>(kParticles));
  const double variance_error = std::sqrt(2.0) * mean_error;
  EXPECT_LT(std::abs(bias), 0.2 * mean_error);
  EXPECT_LT(std::sqrt(mean_square), 2 * mean_error);
  EXPECT_LT(std::sqrt(variance_square), 2 * variance_error);
}

TEST(ParticleFilter, PredictsWithoutMeasurement) {  // Eq. 7
  const auto filter = make_particle_filter(kParticles, 7);
  filter->reset({100, 0.25});
  for (int k = 0; k < 4; ++k) filter->predict(3, 0.5);
  EXPECT_NEAR(filter->belief().along_m, 112, 0.1);
  EXPECT_NEAR(filter->belief().variance_m2, 1.25, 0.12);
}

TEST(ParticleFilter, AMeasurementFarFromEveryParticleLeavesABelief) {
  const auto filter = make_particle_filter(kParticles, 7);
  filter->reset({100, 0.01});
  filter->predict(2, 0.1);
  filter->update({500, 0.05, 20}, 0.1);
  EXPECT_NEAR(filter->belief().along_m, 102.5, 0.5);  // the particle nearest to it
  filter->predict(2, 0.1);
  EXPECT_TRUE(std::isfinite(filter->belief().variance_m2));
}

TEST(ParticleFilter, TheSameSeedGivesTheSameBeliefs) {
  const auto after = [](std::uint64_t seed) {
    const auto filter = make_particle_filter(100, seed);
    filter->reset({100, 1});
    for (int k = 0; k < 5; ++k) {
      filter->predict(2, 0.5);
      filter->update({102.0 + 2 * k, 0.5, 20}, 1);
    }
    return filter->belief().along_m;
  };
  EXPECT_EQ(after(1), after(1));
  EXPECT_NE(after(1), after(2));
}

TEST(PaperTracker, ParticlesFollowAsKalmansFilterDoes) {
  PaperTrackerSettings settings;
  const auto kalman = make_paper_tracker(settings);
  settings.filter = PaperFilter::particle;
  const auto particles = make_paper_tracker(settings);
  for (auto* tracker : {kalman.get(), particles.get()}) tracker->start(0, {100, 0.5, 20});
  for (int k = 1; k <= 20; ++k) {
    const Measurement measured{100 + 2.0 * k + (k % 3 - 1) * 0.6, 0.5, 20};
    for (auto* tracker : {kalman.get(), particles.get()}) tracker->advance(0.2 * k, measured);
    EXPECT_NEAR(particles->pose().along_m, kalman->pose().along_m, 0.15);
    EXPECT_NEAR(particles->pose().sigma_m, kalman->pose().sigma_m, 0.05);
  }
}

}  // namespace
}  // namespace milepost
