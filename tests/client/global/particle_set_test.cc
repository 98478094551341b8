#include "client/global/particle_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "tests/client/global/plan_rooms.h"

namespace milepost {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;

// Eq. 1 by hand: the heading is clockwise from north, where the paper's is counterclockwise from
// east.
TEST(Moved, GoesAlongTheChordHalfWayThroughTheTurn) {
  const Pose2 pose = moved({{10, 20}, 0}, 2, kQuarter);
  EXPECT_NEAR(pose.enu_m.x(), 10 + 2 * std::sin(kQuarter / 2), 1e-12);
  EXPECT_NEAR(pose.enu_m.y(), 20 + 2 * std::cos(kQuarter / 2), 1e-12);
  EXPECT_DOUBLE_EQ(pose.heading_rad, kQuarter);
}

TEST(ParticleSet, AUniformOneFillsAreaAndHeadings) {
  Random random(1);
  const PlanBox area{{-10, 5}, {30, 15}};
  const ParticleSet particles = uniform_particles(4000, area, random);
  std::map<std::pair<bool, bool>, int> quarters;
  double weights = 0;
  int looks_east = 0;
  for (const Particle& particle : particles) {
    ASSERT_TRUE(area.contains(particle.pose.enu_m));
    ++quarters[{particle.pose.enu_m.x() < 10, particle.pose.enu_m.y() < 10}];
    looks_east += std::sin(particle.pose.heading_rad) > 0 ? 1 : 0;
    weights += particle.weight;
  }
  for (const auto& [quarter, count] : quarters) EXPECT_NEAR(count, 1000, 120);
  EXPECT_NEAR(looks_east, 2000, 140);
  EXPECT_NEAR(weights, 1, 1e-9);
}

TEST(ParticleSet, OneAboutAStartHasItsSpread) {
  Random random(1);
  const ParticleSet particles = particles_about({{{100, 200}, 1}, 4, 0.2}, 4000, random);
  double east = 0;
  double east2 = 0;
  double heading2 = 0;
  for (const Particle& particle : particles) {
    east += particle.pose.enu_m.x() - 100;
    east2 += std::pow(particle.pose.enu_m.x() - 100, 2);
    heading2 += std::pow(particle.pose.heading_rad - 1, 2);
  }
  EXPECT_NEAR(east / 4000, 0, 0.3);
  EXPECT_NEAR(std::sqrt(east2 / 4000), 4, 0.2);
  EXPECT_NEAR(std::sqrt(heading2 / 4000), 0.2, 0.01);
}

TEST(ParticleSet, WithoutNoiseAllMoveAlike) {
  Random random(1);
  const RayCastingGrid walls({{{-50, 90}, {50, 90}, 0.1}});
  const PlanBox area{{-100, -100}, {100, 100}};
  ParticleSet particles(3, {{{0, 0}, 0}, 1.0 / 3});
  EXPECT_EQ(propagate(particles, {1, 10, 0.2}, {}, walls, area, Crossing::drawn_anew, random), 0U);
  for (const Particle& particle : particles) {
    EXPECT_NEAR(particle.pose.enu_m.x(), 10 * std::sin(0.1), 1e-12);
    EXPECT_NEAR(particle.pose.heading_rad, 0.2, 1e-12);
  }
}

TEST(ParticleSet, NoiseGrowsWithTimeWhereTheDistanceIsShort) {
  Random random(1);
  const RayCastingGrid walls({{{-50, 900}, {50, 900}, 0.1}});
  const PlanBox area{{-1000, -1000}, {1000, 1000}};
  ParticleSet particles(4000, {{{0, 0}, 0}, 1.0 / 4000});
  propagate(particles, {4, 0.5, 0}, {0.1, 0.03, 0}, walls, area, Crossing::drawn_anew, random);
  double along2 = 0;
  for (const Particle& particle : particles) along2 += std::pow(particle.pose.enu_m.y() - 0.5, 2);
  EXPECT_NEAR(std::sqrt(along2 / 4000), 0.2, 0.01);
}

TEST(ParticleSet, NoiseGrowsWithTimeAndDistance) {
  Random random(1);
  const RayCastingGrid walls({{{-50, 900}, {50, 900}, 0.1}});
  const PlanBox area{{-1000, -1000}, {1000, 1000}};
  ParticleSet particles(4000, {{{0, 0}, 0}, 1.0 / 4000});
  propagate(particles, {4, 100, 0}, {0.1, 0.03, 0.01}, walls, area, Crossing::drawn_anew, random);
  double along2 = 0;
  double turn2 = 0;
  for (const Particle& particle : particles) {
    along2 += std::pow(particle.pose.enu_m.norm() - 100, 2);
    turn2 += std::pow(particle.pose.heading_rad, 2);
  }
  EXPECT_NEAR(std::sqrt(along2 / 4000), std::hypot(0.2, 3), 0.15);
  EXPECT_NEAR(std::sqrt(turn2 / 4000), 0.02, 0.001);
}

// Section IV, last sentence on the filter: particles that move through a building are redrawn.
TEST(ParticleSet, EachUsesItsOwnOdometryScale) {
  Random random(1);
  const RayCastingGrid walls({});
  const PlanBox area{{-50, -50}, {50, 50}};
  ParticleSet particles = {{{{0, 0}, 0}, 0.5, 1.1}, {{{0, 0}, 0}, 0.5, 0.9}};
  propagate(particles, {1, 10, 0}, {}, walls, area, Crossing::drawn_anew, random);
  EXPECT_NEAR(particles[0].pose.enu_m.y(), 11, 1e-9);
  EXPECT_NEAR(particles[1].pose.enu_m.y(), 9, 1e-9);
  EXPECT_EQ(particles[0].odometry_scale, 1.1);
}

TEST(ParticleSet, ScalesAreDrawnAndWanderWithDistance) {
  Random random(1);
  const RayCastingGrid walls({});
  const PlanBox area{{-500, -500}, {500, 500}};
  ParticleSet particles(4000, {{{0, 0}, 0}, 1.0 / 4000});
  const auto spread = [&] {
    double sum = 0;
    for (const Particle& particle : particles) sum += std::pow(particle.odometry_scale - 1, 2);
    return std::sqrt(sum / 4000);
  };
  MotionNoise noise;
  noise.scale = 0.01;
  propagate(particles, {1, 0, 0}, noise, walls, area, Crossing::drawn_anew, random);
  EXPECT_EQ(spread(), 0);
  propagate(particles, {1, 16, 0}, noise, walls, area, Crossing::drawn_anew, random);
  EXPECT_NEAR(spread(), 0.04, 0.002);
  draw_odometry_scales(particles, 0.1, random);
  EXPECT_NEAR(spread(), 0.1, 0.005);
}

TEST(ParticleSet, ResamplingKeepsTheOdometryScale) {
  Random random(1);
  const ParticleSet particles = {{{{0, 0}, 0}, 0.999, 1.1}, {{{0, 0}, 0}, 0.001, 0.9}};
  EXPECT_EQ(resampled(particles, 1, random).front().odometry_scale, 1.1);
}

TEST(ParticleSet, ThoseThatCrossAWallOrLeaveAreDrawnAnew) {
  Random random(1);
  const RayCastingGrid walls({{{-1, 5}, {1, 5}, 0.1}});
  const PlanBox area{{-50, -50}, {50, 50}};
  ParticleSet particles(100, {{{0, 0}, 0}, 0.01});
  EXPECT_EQ(propagate(particles, {1, 6, 0}, {}, walls, area, Crossing::drawn_anew, random), 100U);
  int beyond = 0;
  for (const Particle& particle : particles) {
    EXPECT_TRUE(area.contains(particle.pose.enu_m));
    beyond += particle.pose.enu_m.norm() > 10 ? 1 : 0;
  }
  EXPECT_GT(beyond, 80);
  ParticleSet leaving(10, {{{0, 48}, 0}, 0.1});
  EXPECT_EQ(propagate(leaving, {1, 6, 0}, {}, walls, area, Crossing::drawn_anew, random), 10U);
}

TEST(ParticleSet, WhereTheStartIsKnownThoseThatCrossAWallAreDropped) {
  Random random(1);
  const RayCastingGrid walls({{{-1, 5}, {1, 5}, 0.1}});
  const PlanBox area{{-50, -50}, {50, 50}};
  ParticleSet particles = {{{{0, 0}, 0}, 0.5}, {{{10, 0}, 0}, 0.3}, {{{20, 0}, 0}, 0.2}};
  EXPECT_EQ(propagate(particles, {1, 6, 0}, {}, walls, area, Crossing::dropped, random), 1U);
  ASSERT_EQ(particles.size(), 2U);
  EXPECT_EQ(particles[0].pose.enu_m, Eigen::Vector2d(10, 6));
  EXPECT_NEAR(particles[0].weight, 0.6, 1e-12);
  EXPECT_NEAR(particles[1].weight, 0.4, 1e-12);
  ParticleSet all(4, {{{0, 0}, 0}, 0.25});
  EXPECT_EQ(propagate(all, {1, 6, 0}, {}, walls, area, Crossing::dropped, random), 4U);
  EXPECT_EQ(all.size(), 4U);
}

TEST(ParticleSet, WeighingMultipliesAndNormalizes) {
  ParticleSet particles = {{{{0, 0}, 0}, 0.5}, {{{1, 0}, 0}, 0.25}, {{{2, 0}, 0}, 0.25}};
  const double log_likelihood = update_weights(particles, {-1000, -1000 + std::log(2), -1000});
  EXPECT_NEAR(log_likelihood, -1000 + std::log(1.25), 1e-9);
  EXPECT_NEAR(particles[0].weight, 0.4, 1e-12);
  EXPECT_NEAR(particles[1].weight, 0.4, 1e-12);
  EXPECT_NEAR(particles[2].weight, 0.2, 1e-12);
  EXPECT_NEAR(effective_count(particles), 1 / (0.16 + 0.16 + 0.04), 1e-9);
}

TEST(ParticleSet, JitterMovesEachByItsOwnNoise) {
  Random random(3);
  ParticleSet particles(2000, {{{5, -3}, 1}, 1.0 / 2000});
  jitter(particles, 2, 0.1, random);
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  double turns = 0;
  for (const Particle& particle : particles) {
    squares += (particle.pose.enu_m - Eigen::Vector2d(5, -3)).cwiseAbs2() / 2000;
    turns += std::pow(particle.pose.heading_rad - 1, 2) / 2000;
  }
  EXPECT_NEAR(std::sqrt(squares.x()), 2, 0.1);
  EXPECT_NEAR(std::sqrt(squares.y()), 2, 0.1);
  EXPECT_NEAR(std::sqrt(turns), 0.1, 0.005);
}

// Low variance: each particle occurs as often as its weight demands, rounded up or down.
TEST(ParticleSet, ResamplingKeepsSharesToOneParticle) {
  Random random(7);
  ParticleSet particles;
  const double weights[] = {0.501, 0.003, 0.246, 0.25, 0};
  for (const double weight : weights) {
    particles.push_back({{{static_cast<double>(particles.size()), 0}, 0}, weight});
  }
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<int> counts(particles.size(), 0);
    const ParticleSet chosen = resampled(particles, 200, random);
    ASSERT_EQ(chosen.size(), 200U);
    for (const Particle& particle : chosen) {
      ++counts[static_cast<std::size_t>(particle.pose.enu_m.x())];
      EXPECT_DOUBLE_EQ(particle.weight, 1.0 / 200);
    }
    for (std::size_t i = 0; i < counts.size(); ++i) EXPECT_NEAR(counts[i], 200 * weights[i], 1);
  }
}

// On average a particle with an expected count of 0.6 occurs 0.6 times.
TEST(ParticleSet, ResamplingFavoursNone) {
  Random random(3);
  const ParticleSet particles = {{{{0, 0}, 0}, 0.003}, {{{1, 0}, 0}, 0.997}};
  int first = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    first += resampled(particles, 200, random).front().pose.enu_m.x() < 0.5 ? 1 : 0;
  }
  EXPECT_NEAR(first / 2000.0, 0.6, 0.05);
}

// Because of rounding the weights may add up to less than 1.
TEST(ParticleSet, ResamplingEndsWithTheLastParticle) {
  Random random(3);
  const ParticleSet particles = {{{{0, 0}, 0}, 0.5}, {{{1, 0}, 0}, 0.4}};
  int last = 0;
  for (const Particle& particle : resampled(particles, 100, random)) {
    last += particle.pose.enu_m.x() == 1 ? 1 : 0;
  }
  EXPECT_NEAR(last, 50, 1);
}

TEST(ParticleSet, EnoughParticlesAreAskedByWhereTheyLie) {
  const auto enough = [](const Eigen::Vector2d& step_m, double turn_rad) {
    ParticleSet particles;
    particles.reserve(100);
    for (int i = 0; i < 100; ++i) particles.push_back({{step_m * i, turn_rad * i}, 0.01});
    return enough_particles(particles, 1, 0.1);
  };
  EXPECT_EQ(enough({0, 0}, 0), 200U);
  EXPECT_GT(enough({1, 0}, 0), 1000U);
  EXPECT_EQ(enough({0, 1}, 0), enough({1, 0}, 0));
  EXPECT_EQ(enough({0, 0}, 2 * std::numbers::pi), 200U);  // all have the same heading
}

TEST(ParticleSet, ABeliefOfManyHeadingsTakesMoreParticles) {
  Random random(1);
  const auto enough = [&](double sigma_rad) {
    return enough_particles(particles_about({{{0, 0}, 0}, 0.01, sigma_rad}, 3000, random), 1, 0.02);
  };
  EXPECT_GT(enough(0.5), 2 * enough(0.05));
}

TEST(ParticleSet, AWideBeliefTakesMoreParticles) {
  Random random(1);
  const auto enough = [&](double sigma_m) {
    return enough_particles(particles_about({{{0, 0}, 0}, sigma_m, 0.02}, 3000, random), 1, 0.1);
  };
  EXPECT_EQ(enough(0.01), 200U);
  EXPECT_GT(enough(1.5), 300U);
  EXPECT_GT(enough(6), 2 * enough(1.5));
}

}  // namespace
}  // namespace milepost
