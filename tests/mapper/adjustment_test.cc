#include "mapper/landmarks/adjustment.h"

#include <gtest/gtest.h>

#include <cmath>

#include "schema/geo/geodesy.h"
#include "tests/mapper/made_up_street.h"

namespace milepost {
namespace {

using testing::kStreetPinhole;
using testing::MadeUpStreet;
using testing::StreetPlan;

const StreetPlan kNoisyPoses{.mounting_deg = 1.5,
                             .heading_noise_deg = 0.5,
                             .position_noise_m = 0.04,
                             .tilt_deg = 0.5,
                             .pixel_noise_px = 0.5};

struct Errors {
  double position_m = 0;  // root mean squares
  double heading_deg = 0;
  double pitch_deg = 0;
  double roll_deg = 0;
};

Errors errors_of(const std::vector<CameraPose>& poses, const std::vector<CameraPose>& truth,
                 std::size_t first = 0) {
  Errors sum;
  for (std::size_t i = first; i < poses.size(); ++i) {
    sum.position_m += (poses[i].enu_m - truth[i].enu_m).squaredNorm();
    sum.heading_deg += std::pow((poses[i].heading_rad - truth[i].heading_rad) / kRadPerDeg, 2);
    sum.pitch_deg += std::pow((poses[i].pitch_rad - truth[i].pitch_rad) / kRadPerDeg, 2);
    sum.roll_deg += std::pow((poses[i].roll_rad - truth[i].roll_rad) / kRadPerDeg, 2);
  }
  const auto count = static_cast<double>(poses.size() - first);
  return {std::sqrt(sum.position_m / count), std::sqrt(sum.heading_deg / count),
          std::sqrt(sum.pitch_deg / count), std::sqrt(sum.roll_deg / count)};
}

bool same(const CameraPose& a, const CameraPose& b) {
  return a.enu_m == b.enu_m && a.heading_rad == b.heading_rad && a.pitch_rad == b.pitch_rad &&
         a.roll_rad == b.roll_rad;
}

// Every tenth track takes its second half from another, as after a wrong match.
std::vector<FeatureTrack> with_wrong_ones(std::vector<FeatureTrack> tracks) {
  for (std::size_t i = 0; i + 1 < tracks.size(); i += 10) {
    FeatureTrack& track = tracks[i];
    for (std::size_t k = track.size() / 2; k < track.size(); ++k) {
      track[k].pixel = tracks[i + 1][k % tracks[i + 1].size()].pixel;
    }
  }
  return tracks;
}

TEST(AdjustPoses, FindsWhatTheRecordDoesNotSay) {
  MadeUpStreet street(kNoisyPoses);
  std::vector<CameraPose> poses = street.recorded;
  const Errors before = errors_of(poses, street.poses);
  EXPECT_GT(before.heading_deg, 1.4);
  EXPECT_GT(before.pitch_deg, 0.4);
  adjust_poses(poses, 0, with_wrong_ones(street.sights_of_all()), kStreetPinhole, {});
  const Errors after = errors_of(poses, street.poses);
  EXPECT_LT(after.heading_deg, 0.1);
  EXPECT_LT(after.pitch_deg, 0.1);
  EXPECT_LT(after.roll_deg, 0.25);
  EXPECT_LT(after.position_m, before.position_m);
}

// Positions that agree with the images from frame to frame are held closer than others.
TEST(AdjustPoses, TrustsPositionsAsFarAsTheImagesDo) {
  const auto error_m = [](double noise_m, const AdjustmentSettings& settings) {
    MadeUpStreet street({.frames = 60,
                         .points = 450,
                         .heading_noise_deg = 0.3,
                         .position_noise_m = noise_m,
                         .pixel_noise_px = 0.5});
    std::vector<CameraPose> poses = street.recorded;
    adjust_poses(poses, 0, street.sights_of_all(), kStreetPinhole, settings);
    return errors_of(poses, street.poses).position_m;
  };
  AdjustmentSettings fixed;
  fixed.least_position_sigma_m = fixed.greatest_position_sigma_m = fixed.position_sigma_m;
  EXPECT_LT(error_m(0, {}), 0.6 * error_m(0, fixed));
  EXPECT_LT(error_m(0.03, {}), 1.05 * error_m(0.03, fixed));
  EXPECT_LT(error_m(0.3, {}), 0.5 * error_m(0.3, fixed));
}

// One kind of noise at a time, of which the images know better than the record.
TEST(AdjustPoses, ImagesOutweighARecordThatTheyContradict) {
  const auto errors = [](double altitude_noise_m, double heading_noise_deg) {
    MadeUpStreet street({.frames = 60,
                         .points = 450,
                         .heading_noise_deg = heading_noise_deg,
                         .altitude_noise_m = altitude_noise_m,
                         .pixel_noise_px = 0.5});
    std::vector<CameraPose> poses = street.recorded;
    adjust_poses(poses, 0, street.sights_of_all(), kStreetPinhole, {});
    return errors_of(poses, street.poses);
  };
  EXPECT_LT(errors(1, 0.3).position_m, 0.25);
  EXPECT_LT(errors(0, 5).heading_deg, 0.1);
}

TEST(AdjustPoses, FinalPosesDoNotMove) {
  MadeUpStreet street(kNoisyPoses);
  std::vector<CameraPose> poses = street.recorded;
  for (std::size_t i = 0; i < 10; ++i) poses[i] = street.poses[i];
  adjust_poses(poses, 10, street.sights_of_all(), kStreetPinhole, {});
  for (std::size_t i = 0; i < 10; ++i) EXPECT_TRUE(same(poses[i], street.poses[i])) << i;
  const Errors after = errors_of(poses, street.poses, 10);
  EXPECT_LT(after.heading_deg, 0.1);
  EXPECT_LT(after.pitch_deg, 0.1);
}

TEST(AdjustPoses, TheSameInputGivesTheSamePoses) {
  std::vector<std::vector<CameraPose>> runs;
  for (int run = 0; run < 2; ++run) {
    MadeUpStreet street(kNoisyPoses);
    runs.push_back(street.recorded);
    adjust_poses(runs.back(), 0, with_wrong_ones(street.sights_of_all()), kStreetPinhole, {});
  }
  for (std::size_t i = 0; i < runs[0].size(); ++i) EXPECT_TRUE(same(runs[0][i], runs[1][i])) << i;
}

TEST(AdjustPoses, WithoutTracksPosesStayAsRecorded) {
  const MadeUpStreet street(kNoisyPoses);
  std::vector<CameraPose> poses = street.recorded;
  adjust_poses(poses, 3, {}, kStreetPinhole, {});
  const Errors moved = errors_of(poses, street.recorded);
  EXPECT_LT(moved.position_m, 1e-9);
  EXPECT_LT(moved.heading_deg, 1e-9);
  EXPECT_LT(moved.pitch_deg, 1e-9);
  EXPECT_LT(moved.roll_deg, 1e-9);
}

// Final headings include the mounting: they no longer constrain it.
TEST(AdjustPoses, FinalPosesDoNotHideTheMounting) {
  MadeUpStreet street({.frames = 30, .points = 400, .mounting_deg = 1.5, .pixel_noise_px = 0.3});
  std::vector<CameraPose> poses = street.recorded;
  for (std::size_t i = 0; i < 20; ++i) poses[i] = street.poses[i];
  std::vector<FeatureTrack> tracks;  // none in the last two frames: only priors constrain them
  for (FeatureTrack& track : street.sights_of_all()) {
    std::erase_if(track,
                  [](const PixelObservation& observation) { return observation.frame >= 28; });
    if (track.size() >= 3) tracks.push_back(std::move(track));
  }
  adjust_poses(poses, 20, tracks, kStreetPinhole, {});
  EXPECT_NEAR(poses[29].heading_rad / kRadPerDeg, street.poses[29].heading_rad / kRadPerDeg, 0.15);
}

// A frame whose record is wrong is told apart from the others.
TEST(AdjustPoses, EachFrameTellsHowFarItsRecordIsOff) {
  MadeUpStreet street({.frames = 40, .points = 400, .pixel_noise_px = 0.5});
  std::vector<CameraPose> poses = street.recorded;
  poses[25].enu_m.z() += 0.3;
  const auto witness = adjust_poses(poses, 10, street.sights_of_all(), kStreetPinhole, {});
  ASSERT_EQ(witness.size(), 30U);
  for (std::size_t i = 0; i < witness.size(); ++i) {
    EXPECT_EQ(witness[i].frames, 1U);
    if (i == 15) {
      EXPECT_GT(witness[i].up_rms_m(), 0.2);
    } else {
      EXPECT_LT(witness[i].up_rms_m(), 0.1) << i;
    }
  }
  ImageWitness all;
  for (const ImageWitness& each : witness) all += each;
  EXPECT_EQ(all.frames, 30U);
  EXPECT_GT(all.tracks, 100U);
  EXPECT_GT(all.fitting_share(), 0.95);
  // Noise of 0.5 px on two axes, of which the points' positions take some.
  EXPECT_GT(all.reprojection_rms_px(), 0.3);
  EXPECT_LT(all.reprojection_rms_px(), 0.9);
}

}  // namespace
}  // namespace milepost
