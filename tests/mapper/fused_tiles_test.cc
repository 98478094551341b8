// From tracks to the tiles of the default method: survey, store, fused tiles.
#include "mapper/pipeline/fused_tiles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "mapper/pipeline/landmark_survey.h"
#include "schema/tile/codec.h"
#include "tests/mapper/made_up_street.h"

namespace milepost {
namespace {

using testing::kFrameSpacingM;
using testing::kStreetCamera;
using testing::MadeUpStreet;

constexpr double kTileLengthM = 20;
constexpr std::size_t kFrames = 96;  // 187 m: the last tile's stretch is shorter

struct MadeLayer {
  RouteLine line;
  std::vector<BuiltTile> tiles;
  std::vector<PositionError> known;  // of each segment
};

PcaProjection projection() {
  std::vector<Descriptor> descriptors;
  for (std::size_t i = 0; i < 1000; ++i) descriptors.push_back(testing::descriptor_of(i));
  return PcaProjection::trained(descriptors, 0.02);
}

// The tiles of a street of 900 points, cut into segments there, as they become complete.
MadeLayer layer_of(double size_target_kb_per_m, const std::vector<double>& cuts_m = {}) {
  MadeUpStreet street({.frames = kFrames,
                       .points = 900,
                       .mounting_deg = 1,
                       .heading_noise_deg = 0.3,
                       .tilt_deg = 0.3,
                       .pixel_noise_px = 0.3});
  std::vector<GeoPoint> vertices;
  for (std::size_t i = 0; i < kFrames; ++i) vertices.push_back(street.frame(i).position);
  RouteLine line = RouteLine::from_vertices(std::move(vertices)).value();
  BuildPlan plan;
  StretchPlan stretch{{}, line, {}, {}};
  const auto add_segment = [&](const std::string& id, const AlongRange& range) {
    const RouteLine part = part_of(line, range);
    stretch.passes.push_back({plan.fused.size(), 0, range, true});
    stretch.segments.push_back({id, range, part});
    plan.fused.push_back({id, part, {{0, range}}});
  };
  double from_m = 0;
  for (const double cut_m : cuts_m) {
    add_segment("to-" + std::to_string(std::lround(cut_m)), {from_m, cut_m});
    from_m = cut_m;
  }
  add_segment("s", {from_m, line.length_m()});
  Drive drive;
  drive.name = "street";
  plan.drives.push_back({&drive, {stretch}});
  BuildSettings settings;
  settings.tile_length_m = kTileLengthM;
  settings.landmarks.size_target_kb_per_m = size_target_kb_per_m;
  settings.landmarks.landmarks.window_frames = 30;
  settings.landmarks.landmarks.overlap_frames = 20;
  LandmarkStore store = LandmarkStore::create().value();
  LandmarkSurvey survey(kStreetCamera, stretch, plan, settings, store);

  std::map<std::size_t, std::vector<Track>> ended;
  for (std::size_t i = 0; i < street.points.size(); ++i) {
    Track track = street.track_of(i);
    if (track.empty()) continue;
    const auto last = static_cast<std::size_t>(std::lround(track.back().along_m / kFrameSpacingM));
    ended[last + 1].push_back(std::move(track));
  }
  for (std::size_t i = 0; i <= kFrames; ++i) {
    if (i < kFrames) survey.add_frame(street.frame(i), static_cast<double>(i) * kFrameSpacingM);
    survey.add_tracks(ended[i]);
    EXPECT_TRUE(survey.store(i == kFrames).ok());
  }
  MadeLayer made{std::move(line), {}, {}};
  const PcaProjection compact = projection();
  const auto built = build_fused_tiles(plan, store, compact, settings, [&](const BuiltTile& tile) {
    made.tiles.push_back(tile);
    return ok_status();
  });
  EXPECT_TRUE(built.ok());
  if (built) made.known = built->left;
  return made;
}

TEST(FusedTiles, NoTileWeighsMoreThanItsStretchMay) {
  std::map<double, std::size_t> items;
  for (const double target_kb_per_m : {0.05, 0.2, 0.5}) {
    SCOPED_TRACE(target_kb_per_m);
    const MadeLayer made = layer_of(target_kb_per_m);
    ASSERT_GE(made.tiles.size(), 8U);
    double bytes = 0;
    for (const BuiltTile& tile : made.tiles) {
      const double stretch_m =
          std::min(kTileLengthM, made.line.length_m() - tile.index * kTileLengthM);
      EXPECT_LE(static_cast<double>(tile.frame.size()), 1000 * target_kb_per_m * stretch_m)
          << tile.index;
      bytes += static_cast<double>(tile.frame.size());
      items[target_kb_per_m] += tile.items;
    }
    if (target_kb_per_m < 0.1) {  // there are enough landmarks to fill it
      EXPECT_GT(bytes, 800 * target_kb_per_m * 160);
    }
  }
  EXPECT_LT(items[0.05], items[0.2]);
  EXPECT_LE(items[0.2], items[0.5]);
  EXPECT_GT(items[0.5], 500U);
}

TEST(FusedTiles, EachTileComesOnceWithARangeThatHoldsItsLandmarks) {
  const MadeLayer made = layer_of(0.2);
  std::uint32_t next = 0;
  for (const BuiltTile& tile : made.tiles) {
    EXPECT_GE(tile.index, next);
    next = tile.index + 1;
    const Result<LandmarkTile> read = decode_landmarks(tile.frame);
    ASSERT_TRUE(read.ok()) << read.error().line();
    EXPECT_EQ(read->segment, "s");
    EXPECT_EQ(read->index, tile.index);
    EXPECT_DOUBLE_EQ(read->origin_m, tile.index * kTileLengthM);
    ASSERT_EQ(read->landmarks.size(), tile.items);
    for (const Landmark& landmark : read->landmarks) {
      EXPECT_LE(tile.along.from_m, landmark.along.from_m);
      EXPECT_GE(tile.along.to_m, landmark.along.to_m);
      EXPECT_GE(landmark.along.from_m, read->origin_m);
      EXPECT_LE(landmark.along.from_m, read->origin_m + kTileLengthM + 0.1);
    }
  }
}

TEST(FusedTiles, WhereALoneDriveSaysNothingTheUsualErrorIsAssumed) {
  const MadeLayer made = layer_of(0.2, {60, 130});
  ASSERT_EQ(made.known.size(), 3U);
  for (const PositionError& error : made.known)
    EXPECT_EQ(error, (PositionError{0.18, 200, true}));  // of bias and drift
}

TEST(FusedTiles, ATileThatHoldsNothingIsNotStored) {
  EXPECT_THAT(layer_of(0.001).tiles, ::testing::IsEmpty());  // 20 bytes are less than any tile
}

// The stored landmarks are at the positions of the street's points.
TEST(FusedTiles, LandmarksLieInTheirTilesFrame) {
  MadeUpStreet street({.frames = kFrames, .points = 900, .pixel_noise_px = 0.3});
  const RouteLine line = [&] {
    std::vector<GeoPoint> vertices;
    for (std::size_t i = 0; i < kFrames; ++i) vertices.push_back(street.frame(i).position);
    return RouteLine::from_vertices(std::move(vertices)).value();
  }();
  std::size_t near = 0;
  std::size_t all = 0;
  for (const BuiltTile& tile : layer_of(0.2).tiles) {
    const Result<LandmarkTile> read = decode_landmarks(tile.frame);
    ASSERT_TRUE(read.ok());
    const LocalFrame local(line.point_at(read->origin_m));
    for (const Landmark& landmark : read->landmarks) {
      const Eigen::Vector3d at = MadeUpStreet::enu_of(local.geo_from_enu(landmark.position));
      const bool is_near =
          std::any_of(street.points.begin(), street.points.end(),
                      [&](const auto& point) { return (point.enu_m - at).norm() < 0.3; });
      near += is_near ? 1U : 0U;
      ++all;
    }
  }
  EXPECT_GT(all, 200U);
  EXPECT_GT(static_cast<double>(near), 0.8 * static_cast<double>(all));
}

// A cut takes nothing: each segment holds what is seen from it, also where a track began before it.
TEST(FusedTiles, SegmentsHoldAsMuchAtTheirCutsAsTheUncutRoad) {
  constexpr double kTargetKbPerM = 0.2;
  const std::vector<double> cuts_m = {60, 130};
  const MadeLayer whole = layer_of(kTargetKbPerM);
  const MadeLayer cut = layer_of(kTargetKbPerM, cuts_m);
  // Landmarks of a segment that begins at `from_m` that are seen at a place of the whole road.
  const auto count_seen = [](const MadeLayer& made, const std::string& id, double from_m,
                             double place_m) {
    std::size_t seen = 0;
    for (const BuiltTile& tile : made.tiles) {
      if (tile.segment != id) continue;
      const LandmarkTile read = decode_landmarks(tile.frame).value();
      for (const Landmark& landmark : read.landmarks)
        seen += landmark.along.contains(place_m - from_m) ? 1U : 0U;
    }
    return static_cast<double>(seen);
  };
  const std::vector<std::tuple<std::string, double, double>> cuts = {
      {"to-60", 0, 60}, {"to-130", 60, 130}, {"s", 130, cut.line.length_m()}};
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const auto& [id, from_m, to_m] = cuts[i];
    SCOPED_TRACE(id);
    for (const double place_m : {from_m + 2, from_m + 10, to_m - 30, to_m - 2}) {
      const double whole_seen = count_seen(whole, "s", 0, place_m);
      double seen = count_seen(cut, id, from_m, place_m);
      EXPECT_GE(seen, 0.6 * whole_seen) << place_m;  // alone, for a start there
      if (i > 0) {  // with what the segment before holds beyond its end
        const auto& [before, before_from_m, before_to_m] = cuts[i - 1];
        seen += count_seen(cut, before, before_from_m, place_m);
      }
      EXPECT_GE(seen, 0.9 * whole_seen) << place_m;
    }
  }
}

TEST(FusedTiles, TilesOfACutSegmentLieOnItsOwnLine) {
  const MadeLayer made = layer_of(0.2, {60, 130});
  MadeUpStreet street({.frames = kFrames, .points = 900, .pixel_noise_px = 0.3});
  const RouteLine line = part_of(made.line, {60, 130});
  std::size_t near = 0;
  std::size_t all = 0;
  std::uint32_t last_index = 0;
  for (const BuiltTile& tile : made.tiles) {
    if (tile.segment != "to-130") continue;
    const LandmarkTile read = decode_landmarks(tile.frame).value();
    EXPECT_EQ(read.segment, "to-130");
    last_index = tile.index;
    const LocalFrame local(line.point_at(read.origin_m));
    for (const Landmark& landmark : read.landmarks) {
      EXPECT_GE(landmark.along.from_m, 0);
      EXPECT_LT(landmark.along.from_m, 70.1);
      const Eigen::Vector3d at = MadeUpStreet::enu_of(local.geo_from_enu(landmark.position));
      const bool is_near =
          std::any_of(street.points.begin(), street.points.end(),
                      [&](const auto& point) { return (point.enu_m - at).norm() < 0.3; });
      near += is_near ? 1U : 0U;
      ++all;
    }
  }
  EXPECT_EQ(last_index, 3U);  // of 70 m
  EXPECT_GT(all, 100U);
  EXPECT_GT(static_cast<double>(near), 0.8 * static_cast<double>(all));
}

// A pass 3.5 m to the right of the segment's line, which begins 10 m before it.
TEST(LandmarkSurvey, ALandmarkOfAnotherLaneIsPlacedBesideTheLine) {
  const auto line_at = [](double east_m, double from_m, double to_m) {
    return RouteLine::from_vertices(
               {MadeUpStreet::geo_of({east_m, from_m, 0}), MadeUpStreet::geo_of({east_m, to_m, 0})})
        .value();
  };
  const RouteLine driven = line_at(3.5, -10, 110);
  const RouteLine segment = line_at(0, 0, 100);
  MappedLandmark landmark;
  landmark.along = {40, 60};
  const auto beside = placed_on(landmark, driven, {0, 1, {10, 110}, false}, segment);
  ASSERT_TRUE(beside);
  EXPECT_NEAR(beside->landmark.along.from_m, 30, 0.01);
  EXPECT_NEAR(beside->landmark.along.to_m, 50, 0.01);
  EXPECT_NEAR(beside->landmark.right_m, 3.5, 0.01);
  EXPECT_EQ(beside->pass, 1U);
  EXPECT_EQ(beside->stretch_m, 50);
  // The segment that has the pass's own line.
  const auto on_line = placed_on(landmark, driven, {0, 1, {10, 110}, true}, segment);
  ASSERT_TRUE(on_line);
  EXPECT_EQ(on_line->landmark.right_m, 0);
}

}  // namespace
}  // namespace milepost
