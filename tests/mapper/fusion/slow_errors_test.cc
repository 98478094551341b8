// Drives with known errors: what is left of them after the estimate, and what sigma says of it.
#include "mapper/fusion/slow_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace milepost {
namespace {

constexpr double kRoadM = 600;
constexpr double kPlaceM = 20;
constexpr double kTieSigmaM = 0.015;
constexpr double kTieRollSigmaRad = 0.0005;

struct Noise {
  double bias_m = 0.1;
  double drift_m = 0.15;
};

// The errors of drives at places of one road, every kPlaceM.
class NoisyDrives {
 public:
  NoisyDrives(std::size_t drives, const Noise& noise, unsigned seed, double road_m = kRoadM)
      : random_(seed) {
    const auto places = static_cast<std::size_t>(road_m / kPlaceM) + 1;
    const double decay = std::exp(-kPlaceM / 200);
    for (std::size_t drive = 0; drive < drives; ++drive) {
      const Eigen::Vector3d bias = normal3(noise.bias_m);
      Eigen::Vector3d drift = normal3(noise.drift_m);
      std::vector<Eigen::Vector3d>& errors = errors_.emplace_back();
      for (std::size_t place = 0; place < places; ++place) {
        errors.emplace_back(bias + drift);
        drift = decay * drift + normal3(noise.drift_m * std::sqrt(1 - decay * decay));
      }
      known.push_back({.bias = drive});
      stretches.push_back({drive, road_m});
      rolls_rad.push_back(0);
    }
  }

  // Ties all drives in all places.
  void tie_all(double from_m = 0, double to_m = kRoadM) {
    for (std::size_t a = 0; a < errors_.size(); ++a) {
      for (std::size_t b = a + 1; b < errors_.size(); ++b) {
        for (std::size_t place = 0; place < errors_[a].size(); ++place) {
          const double along_m = static_cast<double>(place) * kPlaceM;
          if (along_m < from_m || along_m > to_m) continue;
          Tie& tie = ties.emplace_back(Tie{{a, along_m}, {b, along_m}});
          tie.difference << errors_[b][place] - errors_[a][place] + normal3(kTieSigmaM),
              rolls_rad[b] - rolls_rad[a];
          tie.covariance.diagonal() << Eigen::Vector3d::Constant(kTieSigmaM * kTieSigmaM),
              kTieRollSigmaRad * kTieRollSigmaRad;
        }
      }
    }
  }

  void add_to_errors(std::size_t drive, const Eigen::Vector3d& error_m) {
    for (Eigen::Vector3d& error : errors_[drive]) error += error_m;
  }

  SlowErrors estimated() const { return estimate_slow_errors(known, stretches, ties, {}); }

  // Root mean squares over drives, places and axes of plan.
  double rms_left_m(const SlowErrors& estimate, std::size_t drives) const {
    double sum = 0;
    double count = 0;
    for (std::size_t drive = 0; drive < drives; ++drive) {
      for (std::size_t place = 0; place < errors_[drive].size(); ++place) {
        sum += left(estimate, drive, place).squaredNorm();
        count += 2;
      }
    }
    return std::sqrt(sum / count);
  }
  // Of the mean of all drives' errors.
  double rms_of_mean_m(std::size_t drives) const {
    double sum = 0;
    const std::size_t places = errors_.front().size();
    for (std::size_t place = 0; place < places; ++place) {
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (std::size_t drive = 0; drive < drives; ++drive) mean += errors_[drive][place];
      sum += (mean / static_cast<double>(drives)).head<2>().squaredNorm() / 2;
    }
    return std::sqrt(sum / static_cast<double>(places));
  }
  // Of errors on either axis within `sigmas` of what is said.
  double part_within(const SlowErrors& estimate, double sigmas) const {
    double within = 0;
    double count = 0;
    for (std::size_t drive = 0; drive < errors_.size(); ++drive) {
      for (std::size_t place = 0; place < errors_[drive].size(); ++place) {
        const Eigen::Vector2d off = left(estimate, drive, place);
        const double sigma_m = estimate.sigma_m(drive, static_cast<double>(place) * kPlaceM);
        for (const double each : off) within += std::abs(each) <= sigmas * sigma_m ? 1 : 0;
        count += 2;
      }
    }
    return within / count;
  }

  std::vector<DriveErrors> known;
  std::vector<DrivenStretch> stretches;
  std::vector<Tie> ties;
  std::vector<double> rolls_rad;  // of each drive

 private:
  Eigen::Vector2d left(const SlowErrors& estimate, std::size_t drive, std::size_t place) const {
    const double along_m = static_cast<double>(place) * kPlaceM;
    return (errors_[drive][place] - estimate.error(drive, along_m).enu_m).head<2>();
  }
  Eigen::Vector3d normal3(double sigma_m) {
    std::normal_distribution<double> normal(0, sigma_m);
    return {normal(random_), normal(random_), normal(random_)};
  }

  std::mt19937 random_;
  std::vector<std::vector<Eigen::Vector3d>> errors_;
};

TEST(SlowErrors, OfFourDrivesIsAboutTheMeanOfTheirErrorsLeft) {
  double left = 0;
  double mean = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    NoisyDrives drives(4, {}, seed);
    drives.tie_all();
    left += drives.rms_left_m(drives.estimated(), 4);
    mean += drives.rms_of_mean_m(4);
  }
  EXPECT_LT(left, 1.1 * mean);
}

TEST(SlowErrors, SigmaHoldsOverDraws) {
  for (const std::size_t count : {2U, 4U}) {
    SCOPED_TRACE(count);
    double within = 0;
    constexpr unsigned kDraws = 16;
    for (unsigned seed = 1; seed <= kDraws; ++seed) {
      NoisyDrives drives(count, {}, seed);
      drives.tie_all();
      within += drives.part_within(drives.estimated(), 2) / kDraws;
    }
    EXPECT_GT(within, 0.9);
    EXPECT_LT(within, 0.99);
  }
}

TEST(SlowErrors, SigmaHoldsWhereTwoBiasesMayAgreeByChance) {
  double within = 0;
  constexpr unsigned kDraws = 150;
  constexpr double kShortRoadM = 200;
  for (unsigned seed = 1; seed <= kDraws; ++seed) {
    NoisyDrives drives(2, {.bias_m = 0.1, .drift_m = 0}, seed, kShortRoadM);
    drives.tie_all();
    within += drives.part_within(drives.estimated(), 2) / kDraws;
  }
  EXPECT_GT(within, 0.92);
  EXPECT_LT(within, 0.99);
}

TEST(SlowErrors, DrivesThatAgreeAreAsExactAsTheirTies) {
  NoisyDrives drives(3, {0, 0}, 1);
  drives.tie_all();
  const SlowErrors estimate = drives.estimated();
  EXPECT_LT(drives.rms_left_m(estimate, 3), 0.004);
  EXPECT_LT(estimate.sigma_m(1, 300), 0.02);
}

TEST(SlowErrors, ADriveThatMeetsNoOtherKeepsItsPositions) {
  NoisyDrives drives(3, {}, 1);
  drives.tie_all();
  std::erase_if(drives.ties, [](const Tie& tie) { return tie.b.stretch == 2; });
  const SlowErrors estimate = drives.estimated();
  EXPECT_TRUE(estimate.error(2, 300).is_zero());
  EXPECT_NEAR(estimate.sigma_m(2, 300), std::hypot(0.1, 0.15), 1e-6);
  EXPECT_FALSE(estimate.error(1, 300).is_zero());
}

TEST(SlowErrors, ADriveElsewhereChangesNoDigit) {
  NoisyDrives drives(4, {}, 1);
  drives.tie_all();
  std::vector<Tie> apart = drives.ties;
  std::erase_if(apart, [](const Tie& tie) { return tie.a.stretch < 2 && tie.b.stretch >= 2; });
  const SlowErrors with = estimate_slow_errors(drives.known, drives.stretches, apart, {});
  std::erase_if(apart, [](const Tie& tie) { return tie.b.stretch >= 2; });
  const SlowErrors without =
      estimate_slow_errors({{.bias = 0}, {.bias = 1}}, {{0, kRoadM}, {1, kRoadM}}, apart, {});
  for (double along_m = 0; along_m < kRoadM; along_m += 7)
    EXPECT_EQ(with.error(1, along_m).enu_m, without.error(1, along_m).enu_m) << along_m;
}

TEST(SlowErrors, WrongTiesPullNothing) {
  NoisyDrives drives(4, {}, 2);
  drives.tie_all();
  const double before_m = drives.rms_left_m(drives.estimated(), 4);
  for (std::size_t i = 3; i < drives.ties.size(); i += 10)
    drives.ties[i].difference.head<3>() += Eigen::Vector3d(1.5, -1, 0);
  EXPECT_LT(drives.rms_left_m(drives.estimated(), 4), before_m + 0.005);
}

TEST(SlowErrors, ADriveThatIsTwoMetresOffCountsForLittle) {
  NoisyDrives drives(5, {}, 3);
  drives.add_to_errors(4, {2, 0, 0});
  drives.tie_all();
  // The four others', within what their own mean allows; the mean of all five would be 0.4 m off.
  EXPECT_LT(drives.rms_left_m(drives.estimated(), 4), drives.rms_of_mean_m(4) + 0.05);
}

TEST(SlowErrors, KnownOnAPartOfTheRoadTheErrorsFadeOutBeyond) {
  NoisyDrives drives(2, {0.02, 0.3}, 4);
  drives.tie_all(0, 200);
  const SlowErrors estimate = drives.estimated();
  EXPECT_LT(estimate.sigma_m(1, 100), 0.9 * estimate.sigma_m(1, kRoadM));
  EXPECT_LT(estimate.error(1, kRoadM).enu_m.norm(), 0.2);
}

TEST(SlowErrors, RollsAreToldApartAndMoveNoPosition) {
  NoisyDrives level(3, {}, 5);
  level.tie_all();
  NoisyDrives rolled(3, {}, 5);
  rolled.rolls_rad = {0.02, -0.01, 0.01};
  rolled.tie_all();
  const SlowErrors estimate = rolled.estimated();
  const double between = estimate.error(0, 300).roll_rad - estimate.error(1, 300).roll_rad;
  EXPECT_NEAR(between, 0.03, 0.001);
  EXPECT_NEAR(rolled.rms_left_m(estimate, 3), level.rms_left_m(level.estimated(), 3), 0.005);
}

TEST(SlowErrors, IsAssumedWhereNeitherADriveNorATieTellsIt) {
  NoisyDrives drives(4, {}, 1);
  drives.tie_all();
  std::erase_if(drives.ties, [](const Tie& tie) { return tie.b.stretch >= 2; });
  drives.known[3].sigma_m = 0.05;
  const SlowErrors estimate = drives.estimated();
  EXPECT_FALSE(estimate.is_assumed(0));
  EXPECT_FALSE(estimate.is_assumed(1));
  EXPECT_TRUE(estimate.is_assumed(2));
  EXPECT_FALSE(estimate.is_assumed(3));
  EXPECT_NEAR(estimate.sigma_m(3, 300), 0.05, 1e-6);
}

TEST(SlowErrors, DrivesOfOneGroupAreNoBetterThanTheirCommonBias) {
  NoisyDrives drives(4, {0, 0.15}, 1);
  drives.tie_all();
  const double apart_m = drives.estimated().sigma_m(0, 300);
  for (DriveErrors& drive : drives.known) drive.bias = 2;
  const SlowErrors grouped = drives.estimated();
  EXPECT_TRUE(grouped.is_assumed(0));
  EXPECT_GT(grouped.sigma_m(0, 300), 0.1);
  EXPECT_LT(grouped.sigma_m(0, 300), std::hypot(0.1, 0.15) - 0.01);  // their drifts average out
  EXPECT_LT(apart_m, grouped.sigma_m(0, 300) - 0.01);
}

TEST(SlowErrors, AStatedSigmaIsAWeight) {
  NoisyDrives drives(2, {0.15, 0}, 3);
  drives.tie_all();
  drives.known[0].sigma_m = 0.02;
  drives.known[1].sigma_m = 0.4;
  const SlowErrors estimate = drives.estimated();
  EXPECT_LT(estimate.error(0, 300).enu_m.head<2>().norm(),
            0.1 * estimate.error(1, 300).enu_m.head<2>().norm());
  EXPECT_NEAR(estimate.sigma_m(0, 300), 0.02, 0.005);
  EXPECT_NEAR(estimate.sigma_m(1, 300), 0.02, 0.01);  // it is tied to the exact one
}

TEST(SlowErrors, AStatementThatTheDrivesContradictIsNotBelieved) {
  NoisyDrives drives(4, {0.2, 0.2}, 2);
  drives.tie_all();
  const double unstated_m = drives.estimated().sigma_m(1, 300);
  for (DriveErrors& drive : drives.known) drive.sigma_m = 0.01;
  EXPECT_GT(drives.estimated().sigma_m(1, 300), 0.4 * unstated_m);
}

TEST(SlowErrors, WhereFramesStateMoreTheErrorIsLarger) {
  NoisyDrives drives(1, {}, 1);
  drives.known[0].sigma_m = 0.1;
  std::vector<double>& factors = drives.stretches[0].sigma_factors;
  factors.assign(node_count(kRoadM, {}), 1);
  for (std::size_t k = factors.size() / 2; k < factors.size(); ++k) factors[k] = 3;
  const SlowErrors estimate = drives.estimated();
  EXPECT_NEAR(estimate.sigma_m(0, 100), 0.1, 1e-6);
  EXPECT_NEAR(estimate.sigma_m(0, 500), 0.3, 1e-6);
}

TEST(SlowErrors, FadeOutOverTheStatedLength) {
  const auto sigma_beyond_m = [](std::optional<double> correlation_m) {
    NoisyDrives drives(2, {0, 0.3}, 4);
    drives.tie_all(0, 200);
    for (DriveErrors& drive : drives.known) {
      drive.sigma_m = 0.3;
      drive.correlation_m = correlation_m;
    }
    const SlowErrors estimate = drives.estimated();
    return estimate.sigma_m(1, 320) / estimate.sigma_m(1, 100);
  };
  EXPECT_GT(sigma_beyond_m(20), 1.1 * sigma_beyond_m(2000));
}

// Two cameras of one vehicle: what they both saw tells nothing of where it was.
TEST(SlowErrors, ASecondCameraNarrowsNoSigma) {
  NoisyDrives drives(3, {}, 1);
  drives.tie_all();
  std::vector<Tie> first_two = drives.ties;
  std::erase_if(first_two, [](const Tie& tie) { return tie.b.stretch == 2; });
  const SlowErrors alone =
      estimate_slow_errors({{.bias = 0}, {.bias = 1}}, {{0, kRoadM}, {1, kRoadM}}, first_two, {});
  drives.known[2].bias = 1;
  drives.stretches[2].same_way = {1, {0, kRoadM}, {0, kRoadM}};
  std::erase_if(drives.ties,
                [](const Tie& tie) { return tie.a.stretch == 0 && tie.b.stretch == 2; });
  const SlowErrors both = drives.estimated();
  for (double along_m = 0; along_m <= kRoadM; along_m += 50) {
    EXPECT_NEAR(both.sigma_m(1, along_m), alone.sigma_m(1, along_m), 1e-9);
    EXPECT_NEAR(both.sigma_m(2, along_m), both.sigma_m(1, along_m), 1e-9);
    EXPECT_LT((both.error(2, along_m).enu_m - both.error(1, along_m).enu_m).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace milepost
