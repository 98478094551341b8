#include "mapper/landmarks/landmark_mapper.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "tests/mapper/made_up_street.h"

namespace milepost {
namespace {

using testing::descriptor_of;
using testing::kFrameSpacingM;
using testing::kStreetCamera;
using testing::MadeUpStreet;
using testing::StreetPlan;

const StreetPlan kNoisy{.mounting_deg = 1.5,
                        .heading_noise_deg = 0.3,
                        .position_noise_m = 0.03,
                        .tilt_deg = 0.3,
                        .pixel_noise_px = 0.3};

LandmarkSettings in_windows(std::size_t frames, std::size_t overlap) {
  LandmarkSettings settings;
  settings.window_frames = frames;
  settings.overlap_frames = overlap;
  return settings;
}

// Passes a street's frames and tracks to a mapper as a build does: each track with the first frame
// that does not continue it.
class Drive {
 public:
  using Change = std::function<void(std::size_t point, Track&)>;

  Drive(MadeUpStreet& street, const LandmarkSettings& settings, const Change& change = {})
      : street_(street), mapper_(kStreetCamera, settings) {
    for (std::size_t i = 0; i < street.points.size(); ++i) {
      Track track = street.track_of(i);
      if (track.empty()) continue;
      if (change) change(i, track);
      expect(std::move(track));
    }
  }

  void add_frame(std::size_t i) {
    mapper_.add_frame(street_.frame(i), static_cast<double>(i) * kFrameSpacingM);
    mapper_.add_tracks(ended_[i]);
    take(false);
  }
  void finish() {
    mapper_.add_tracks(ended_[street_.poses.size()]);
    take(true);
  }
  // Adds a track that is not one of the street's. REQUIRES: no frame was added yet.
  void expect(Track track) {
    const auto last = static_cast<std::size_t>(std::lround(track.back().along_m / kFrameSpacingM));
    ended_[last + 1].push_back(std::move(track));
  }
  const std::vector<MappedLandmark>& mapped() const { return mapped_; }

 private:
  void take(bool finished) {
    const std::vector<MappedLandmark> taken = mapper_.take_mapped(finished);
    mapped_.insert(mapped_.end(), taken.begin(), taken.end());
  }

  MadeUpStreet& street_;
  LandmarkMapper mapper_;
  std::map<std::size_t, std::vector<Track>> ended_;
  std::vector<MappedLandmark> mapped_;
};

std::vector<MappedLandmark> mapped(MadeUpStreet& street, const LandmarkSettings& settings,
                                   const std::vector<Track>& others = {}) {
  Drive drive(street, settings);
  for (const Track& track : others) drive.expect(track);
  for (std::size_t i = 0; i < street.poses.size(); ++i) drive.add_frame(i);
  drive.finish();
  return drive.mapped();
}

std::map<Descriptor, MappedLandmark> by_descriptor(const std::vector<MappedLandmark>& landmarks) {
  std::map<Descriptor, MappedLandmark> found;
  for (const MappedLandmark& landmark : landmarks) found[landmark.descriptor] = landmark;
  return found;
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

// Distances of the landmarks from the true positions of their points.
std::vector<double> place_errors_m(const MadeUpStreet& street,
                                   const std::vector<MappedLandmark>& landmarks) {
  const auto found = by_descriptor(landmarks);
  std::vector<double> errors_m;
  for (std::size_t i = 0; i < street.points.size(); ++i) {
    const auto at = found.find(descriptor_of(i));
    if (at == found.end()) continue;
    errors_m.push_back((MadeUpStreet::enu_of(at->second.position) - street.points[i].enu_m).norm());
  }
  return errors_m;
}

TEST(LandmarkMapper, ExactTracksGiveTheTruePlacesAndSizes) {
  MadeUpStreet street({});
  const std::vector<MappedLandmark> landmarks = mapped(street, {});
  EXPECT_GT(landmarks.size(), 200U);
  EXPECT_LT(quantile(place_errors_m(street, landmarks), 1), 0.02);
  const auto found = by_descriptor(landmarks);
  for (std::size_t i = 0; i < street.points.size(); ++i) {
    const auto at = found.find(descriptor_of(i));
    if (at == found.end()) continue;
    const Track track = street.track_of(i);
    const MappedLandmark& landmark = at->second;
    EXPECT_NEAR(landmark.size_m / street.points[i].size_m, 1, 1e-3);
    EXPECT_LT(landmark.size_sigma, 1e-3);
    EXPECT_EQ(landmark.observations, track.size());
    EXPECT_EQ(landmark.along.from_m, track.front().along_m);
    EXPECT_EQ(landmark.along.to_m, track.back().along_m);
    const auto first =
        static_cast<std::size_t>(std::lround(track.front().along_m / kFrameSpacingM));
    EXPECT_NEAR(landmark.depth_m, (street.points[i].enu_m - street.poses[first].enu_m).norm(),
                0.02);
  }
}

TEST(LandmarkMapper, NoisyDrivesGiveNearlyTheTruePlacesAndSizes) {
  MadeUpStreet street(kNoisy);
  const std::vector<MappedLandmark> landmarks = mapped(street, {});
  EXPECT_GT(landmarks.size(), 200U);
  const std::vector<double> errors_m = place_errors_m(street, landmarks);
  EXPECT_LT(quantile(errors_m, 0.5), 0.15);
  EXPECT_LT(quantile(errors_m, 0.9), 0.5);
  const auto found = by_descriptor(landmarks);
  for (std::size_t i = 0; i < street.points.size(); ++i) {
    const auto at = found.find(descriptor_of(i));
    if (at == found.end()) continue;
    EXPECT_NEAR(at->second.size_m / street.points[i].size_m, 1,
                0.02 + 4 * at->second.depth_sigma_m / at->second.depth_m);
  }
}

TEST(LandmarkMapper, SeveralWindowsGiveWhatOneGives) {
  StreetPlan plan = kNoisy;
  plan.frames = 100;
  plan.points = 700;
  plan.position_noise_m = 0;
  MadeUpStreet street(plan);
  MadeUpStreet again(plan);
  const auto in_one = by_descriptor(mapped(street, in_windows(200, 20)));
  const auto in_several = by_descriptor(mapped(again, in_windows(30, 20)));
  ASSERT_GT(in_one.size(), 500U);
  std::vector<double> distances_m;
  for (const auto& [descriptor, landmark] : in_one) {
    const auto at = in_several.find(descriptor);
    if (at == in_several.end()) continue;
    distances_m.push_back(
        (MadeUpStreet::enu_of(at->second.position) - MadeUpStreet::enu_of(landmark.position))
            .norm());
  }
  EXPECT_GT(distances_m.size(), 0.97 * static_cast<double>(in_one.size()));
  EXPECT_LT(quantile(distances_m, 0.5), 0.05);
  EXPECT_LT(quantile(distances_m, 0.95), 0.3);
}

// The open track began before all frames that ended tracks and the next window require.
TEST(LandmarkMapper, ATrackMayBeLongerThanTheOverlap) {
  MadeUpStreet street({.frames = 70, .farthest_m = 90});
  std::size_t longest = 0;
  for (std::size_t i = 0; i < street.points.size(); ++i) {
    if (street.track_of(i).size() > street.track_of(longest).size()) longest = i;
  }
  ASSERT_GT(street.track_of(longest).size(), 30U);
  Drive drive(street, in_windows(15, 5), [&](std::size_t i, Track& track) {
    const bool is_short = i != longest && track.size() > 6;
    if (is_short) track.erase(track.begin(), track.end() - 6);
  });
  for (std::size_t i = 0; i < street.poses.size(); ++i) drive.add_frame(i);
  drive.finish();
  const auto found = by_descriptor(drive.mapped());
  ASSERT_EQ(found.count(descriptor_of(longest)), 1U);
  const MappedLandmark& landmark = found.at(descriptor_of(longest));
  EXPECT_LT((MadeUpStreet::enu_of(landmark.position) - street.points[longest].enu_m).norm(), 0.1);
  EXPECT_EQ(landmark.along.from_m, street.track_of(longest).front().along_m);
}

// At the camera's height its images would move along the same lines as those of a static point.
TEST(LandmarkMapper, LeavesOutWhatMoves) {
  MadeUpStreet street(kNoisy);
  std::vector<std::size_t> movers;
  for (std::size_t i = 0; i < street.points.size(); i += 15) {
    street.points[i].step_m = {0.26, -0.15, 0};  // across the road, 1.5 m/s at 35 km/h
    street.points[i].enu_m -= 20 * street.points[i].step_m;
    street.points[i].enu_m.z() = 6;
    if (street.track_of(i).size() >= 8) movers.push_back(i);
  }
  ASSERT_GE(movers.size(), 8U);
  const auto found = by_descriptor(mapped(street, {}));
  EXPECT_GT(found.size(), 200U);
  for (const std::size_t i : movers) {
    const auto track = street.track_of(i);
    EXPECT_EQ(found.count(descriptor_of(i)), 0U) << track.size() << " observations";
  }
}

TEST(LandmarkMapper, LeavesOutWhatIsTooFarOrTooUncertain) {
  MadeUpStreet street(kNoisy);
  LandmarkSettings settings;
  settings.max_distance_m = 30;
  settings.max_depth_sigma = 0.05;
  const std::size_t all = mapped(street, {}).size();
  const std::vector<MappedLandmark> landmarks = mapped(street, settings);
  EXPECT_THAT(landmarks.size(), ::testing::AllOf(::testing::Gt(20U), ::testing::Lt(all)));
  for (const MappedLandmark& landmark : landmarks) {
    EXPECT_LE(landmark.depth_m, 30);
    EXPECT_LE(landmark.depth_sigma_m, 0.05 * landmark.depth_m);
  }
}

// A landmark waits for a window, its overlaps, the longest track and what a vehicle ahead may show.
TEST(LandmarkMapper, NothingWaitsForLong) {
  StreetPlan plan;
  plan.frames = 300;
  plan.points = 600;
  plan.turn_deg = 0;
  MadeUpStreet street(plan);
  Drive drive(street, in_windows(20, 5));
  const double longest_m =
      (20 + 2 * 5) * kFrameSpacingM + plan.farthest_m + VehiclesAheadSettings().reach_m;
  std::size_t taken = 0;
  for (std::size_t i = 0; i < street.poses.size(); ++i) {
    drive.add_frame(i);
    for (; taken < drive.mapped().size(); ++taken) {
      EXPECT_GE(drive.mapped()[taken].along.from_m,
                static_cast<double>(i) * kFrameSpacingM - longest_m);
    }
  }
  EXPECT_GT(taken, 250U);
  drive.finish();
  EXPECT_GT(drive.mapped().size(), 500U);
}

// A street with a truck ahead. While the truck falls back, features on it fit as if they stood far
// ahead; it fell away before.
TEST(LandmarkMapper, WhatIsOnAVehicleAheadIsNoLandmark) {
  StreetPlan plan;
  plan.frames = 90;
  plan.points = 300;
  plan.turn_deg = 0;
  plan.pixel_noise_px = 0.3;
  MadeUpStreet street(plan);
  constexpr std::size_t kOnTruck = 40;
  constexpr std::size_t kFirstOnTruck = 5000;
  constexpr double kFallsBackFromM = 90;
  const auto gap_m = [](double along_m) {  // 1 m in 6, away and back
    return 8 + std::min(along_m, 2 * kFallsBackFromM - along_m) / 6;
  };
  std::vector<Track> on_truck;
  for (std::size_t k = 0; k < kOnTruck; ++k) {
    const double right_m = -1 + 0.05 * static_cast<double>(k);
    const double up_m = -0.8 + 0.3 * static_cast<double>(k % 9);
    for (std::size_t first = k % 8; first + 8 < plan.frames; first += 8) {
      Track& track = on_truck.emplace_back();
      for (std::size_t i = first; i < first + 8; ++i) {
        const double along_m = static_cast<double>(i) * kFrameSpacingM;
        const Eigen::Vector2d pixel =
            kStreetCamera.pinhole.project<double>({right_m, -up_m, gap_m(along_m)});
        Observation seen;
        seen.feature = {static_cast<float>(pixel.x()), static_cast<float>(pixel.y()),
                        static_cast<float>(60 / gap_m(along_m))};
        seen.descriptor = descriptor_of(kFirstOnTruck + k);
        seen.along_m = along_m;
        track.push_back(seen);
      }
    }
  }
  const auto far_ones_of_truck = [&](const LandmarkSettings& settings) {
    std::size_t found = 0;
    for (const MappedLandmark& landmark : mapped(street, settings, on_truck)) {
      for (std::size_t k = 0; k < kOnTruck; ++k) {
        const bool is_far = landmark.depth_m > settings.vehicles_ahead.min_distance_m;
        found += is_far && landmark.descriptor == descriptor_of(kFirstOnTruck + k) ? 1 : 0;
      }
    }
    return found;
  };
  LandmarkSettings blind;
  blind.vehicles_ahead.min_receding = 1000000;
  const std::size_t without = far_ones_of_truck(blind);
  EXPECT_GT(without, 60U);
  EXPECT_LT(far_ones_of_truck({}), without / 4);
}

TEST(LandmarkMapper, HeadingsMayCrossNorth) {
  StreetPlan plan = kNoisy;
  plan.frames = 60;
  plan.points = 450;
  for (const double heading_deg : {100.0, 352.0}) {  // 352 turns to 16 degrees
    SCOPED_TRACE(heading_deg);
    plan.heading_deg = heading_deg;
    MadeUpStreet street(plan);
    const std::vector<MappedLandmark> landmarks = mapped(street, in_windows(20, 10));
    EXPECT_GT(landmarks.size(), 300U);
    EXPECT_LT(quantile(place_errors_m(street, landmarks), 0.5), 0.2);
  }
}

TEST(LandmarkMapper, TheSameDriveGivesTheSameLandmarks) {
  std::vector<std::vector<MappedLandmark>> runs;
  for (int run = 0; run < 2; ++run) {
    MadeUpStreet street(kNoisy);
    runs.push_back(mapped(street, in_windows(15, 5)));
  }
  ASSERT_EQ(runs[0].size(), runs[1].size());
  for (std::size_t i = 0; i < runs[0].size(); ++i) {
    EXPECT_EQ(runs[0][i].position, runs[1][i].position);
    EXPECT_EQ(runs[0][i].depth_sigma_m, runs[1][i].depth_sigma_m);
  }
}

}  // namespace
}  // namespace milepost
