#include "mapper/pipeline/fused_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mapper/pipeline/landmark_tile_builder.h"
#include "mapper/pipeline/recordings.h"

namespace milepost {
namespace {

class FusedTiles {
 public:
  FusedTiles(const BuildPlan& plan, LandmarkStore& store, const PcaProjection& projection,
             const BuildSettings& settings)
      : plan_(plan),
        store_(store),
        projection_(projection),
        settings_(settings),
        recorded_(recorded_errors(plan, settings.fusion.errors)) {}

  // The errors of all drives' positions, from the landmarks that they have in common.
  Result<SlowErrors> slow_errors() {
    std::vector<Tie> ties;
    for (std::size_t segment = 0; segment < plan_.fused.size(); ++segment) {
      const Status added = add_ties(segment, ties);
      if (!added.ok()) return added.error();
    }
    return estimate_slow_errors(recorded_.drives, recorded_.stretches, ties,
                                settings_.fusion.errors);
  }

  Status build(const SlowErrors& errors, const std::function<Status(const BuiltTile&)>& use) {
    for (std::size_t segment = 0; segment < plan_.fused.size(); ++segment) {
      const Status built = build_segment(segment, errors, use);
      if (!built.ok()) return built;
    }
    return ok_status();
  }

  // What is left of the errors, for each segment.
  std::vector<PositionError> position_errors(const SlowErrors& errors) const {
    std::vector<PositionError> left;
    for (const FusedSegment& segment : plan_.fused) left.push_back(error_left(segment, errors));
    return left;
  }

 private:
  // The mean over its passes: the vehicle uses the landmarks of all.
  PositionError error_left(const FusedSegment& segment, const SlowErrors& errors) const {
    double squares_m2 = 0;
    double places = 0;
    double correlations_m = 0;
    const SlowErrorSettings& settings = settings_.fusion.errors;
    PositionError left;
    for (const FusedSegment::PassPlace& pass : segment.passes) {
      const double length_m = pass.on_stretch.to_m - pass.on_stretch.from_m;
      const int parts =
          std::max(1, static_cast<int>(std::lround(length_m / settings.node_spacing_m)));
      for (int part = 0; part <= parts; ++part, ++places) {
        const double along_m = pass.on_stretch.from_m + length_m * part / parts;
        squares_m2 += std::pow(errors.sigma_m(pass.stretch, along_m), 2);
      }
      left.is_assumed = left.is_assumed || errors.is_assumed(pass.stretch);
      const std::size_t drive = recorded_.stretches[pass.stretch].drive;
      correlations_m += recorded_.drives[drive].correlation_m.value_or(settings.correlation_m);
    }
    left.sigma_m = rounded_to_mm(std::sqrt(squares_m2 / places));
    left.correlation_m = rounded_to_mm(correlations_m / static_cast<double>(segment.passes.size()));
    return left;
  }

  static double rounded_to_mm(double metres) { return std::round(metres * 1000) / 1000; }

  using ByPass = std::vector<std::vector<PassLandmark>>;

  std::uint32_t tiles_of(const FusedSegment& segment) const {
    return static_cast<std::uint32_t>(segment.line.length_m() / settings_.tile_length_m) + 1;
  }

  // The landmarks of a segment's tile for each pass. Empty beyond the ends.
  Result<ByPass> read(std::size_t segment, std::int64_t tile) {
    ByPass passes(plan_.fused[segment].passes.size());
    if (tile < 0) return passes;
    Result<std::vector<PassLandmark>> all = store_.read(segment, static_cast<std::uint32_t>(tile));
    if (!all) return all.error();
    for (PassLandmark& landmark : *all) passes[landmark.pass].push_back(std::move(landmark));
    return passes;
  }

  Status add_ties(std::size_t index, std::vector<Tie>& ties) {
    const FusedSegment& segment = plan_.fused[index];
    if (segment.passes.size() < 2) return ok_status();
    std::array<ByPass, 3> window;  // the tile before, the tile, the one after
    for (std::int64_t tile = -1; tile < tiles_of(segment); ++tile) {
      std::rotate(window.begin(), window.begin() + 1, window.end());
      Result<ByPass> next = read(index, tile + 1);
      if (!next) return next.error();
      window[2] = std::move(*next);
      if (tile < 0) continue;
      const RoadPlace place =
          road_place(segment.line, (static_cast<double>(tile) + 0.5) * settings_.tile_length_m);
      for (std::size_t a = 0; a < segment.passes.size(); ++a) {
        for (std::size_t b = a + 1; b < segment.passes.size(); ++b) {
          std::vector<PassLandmark> of_b;
          for (const ByPass& near : window) {
            if (!near.empty()) of_b.insert(of_b.end(), near[b].begin(), near[b].end());
          }
          auto tie = tie_of(window[1][a], of_b, place, settings_.fusion.tie);
          if (!tie) continue;
          tie->a.stretch = segment.passes[a].stretch;
          tie->b.stretch = segment.passes[b].stretch;
          ties.push_back(*tie);
        }
      }
    }
    return ok_status();
  }

  Status build_segment(std::size_t index, const SlowErrors& errors,
                       const std::function<Status(const BuiltTile&)>& use) {
    const FusedSegment& segment = plan_.fused[index];
    LandmarkTileBuilder builder(segment.id, segment.line, projection_, settings_.tile_length_m,
                                settings_.landmarks);
    LandmarkMerger merger(LocalFrame(segment.line.point_at(0)), segment.passes.size(),
                          settings_.fusion.merge);
    std::uint32_t next = 0;  // tile to build
    const auto build_before = [&](std::uint32_t tile) -> Status {
      for (; next < tile; ++next) {
        const auto landmarks = merger.take_before((next + 1) * settings_.tile_length_m);
        if (landmarks.empty()) continue;
        const Result<BuiltTile> built = builder.build(next, landmarks);
        if (!built) return built.error();
        if (built->items == 0) continue;
        const Status used = use(*built);
        if (!used.ok()) return used;
      }
      return ok_status();
    };
    const auto reach =
        static_cast<std::uint32_t>(std::ceil(merger.reach_m() / settings_.tile_length_m));
    const std::uint32_t tiles = tiles_of(segment);
    for (std::uint32_t tile = 0; tile < tiles; ++tile) {
      Result<std::vector<PassLandmark>> landmarks = store_.read(index, tile);
      if (!landmarks) return landmarks.error();
      for (PassLandmark& landmark : *landmarks) {
        correct(landmark, segment, errors);
        merger.add(landmark);
      }
      if (tile >= reach) {
        if (const Status built = build_before(tile - reach); !built.ok()) return built;
      }
    }
    return build_before(tiles);
  }

  static void correct(PassLandmark& from, const FusedSegment& segment, const SlowErrors& errors) {
    const PoseError error = errors.error(segment.passes[from.pass].stretch, from.stretch_m);
    if (error.is_zero()) return;
    MappedLandmark& landmark = from.landmark;
    const RoadPlace place = road_place(segment.line, landmark.along.middle_m());
    const EnuPoint recorded = place.local.enu_from_geo(landmark.position);
    const Eigen::Vector3d at_m(recorded.east_m, recorded.north_m, recorded.up_m);
    const Eigen::Vector3d corrected = at_m - error.displacement_m(place, at_m);
    landmark.position = place.local.geo_from_enu({corrected.x(), corrected.y(), corrected.z()});
  }

  const BuildPlan& plan_;
  LandmarkStore& store_;
  const PcaProjection& projection_;
  const BuildSettings& settings_;
  RecordedErrors recorded_;
};

}  // namespace

Result<FusedResult> build_fused_tiles(const BuildPlan& plan, LandmarkStore& store,
                                      const PcaProjection& projection,
                                      const BuildSettings& settings,
                                      const std::function<Status(const BuiltTile&)>& use) {
  FusedTiles tiles(plan, store, projection, settings);
  Result<SlowErrors> errors = tiles.slow_errors();
  if (!errors) return errors.error();
  if (const Status built = tiles.build(*errors, use); !built.ok()) return built.error();
  std::vector<PositionError> left = tiles.position_errors(*errors);
  return FusedResult{std::move(left), std::move(*errors)};
}

}  // namespace milepost
