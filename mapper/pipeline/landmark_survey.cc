#include "mapper/pipeline/landmark_survey.h"

#include <algorithm>

#include "mapper/tracklets/on_segment.h"

namespace milepost {
namespace {

// Where a place of the driven line is beside the segment's line.
LineProjection on_segment(double driven_m, const RouteLine& driven, const AlongRange& pass,
                          const RouteLine& segment) {
  constexpr double kReachM = 30;
  const double part = (driven_m - pass.from_m) / (pass.to_m - pass.from_m);
  const double about_m = std::clamp(part, 0.0, 1.0) * segment.length_m();
  return segment.project(
      driven.point_at(driven_m),
      {std::max(0.0, about_m - kReachM), std::min(segment.length_m(), about_m + kReachM)});
}

}  // namespace

std::optional<PassLandmark> placed_on(const MappedLandmark& landmark, const RouteLine& driven,
                                      const MappedPass& pass, const RouteLine& segment) {
  auto on_pass = landmark_on(landmark, pass.on_stretch);
  if (!on_pass) return std::nullopt;
  const AlongRange& along = landmark.along;
  PassLandmark placed{std::move(*on_pass), pass.pass, (along.from_m + along.to_m) / 2};
  if (pass.is_line) return placed;
  const double from_m = std::max(along.from_m, pass.on_stretch.from_m);
  const double begin_m = on_segment(from_m, driven, pass.on_stretch, segment).along_m;
  placed.landmark.along = {begin_m, begin_m + along.to_m - from_m};
  const double middle_m = std::min((from_m + along.to_m) / 2, pass.on_stretch.to_m);
  placed.landmark.right_m = on_segment(middle_m, driven, pass.on_stretch, segment).lateral_m;
  if (begin_m >= segment.length_m()) return std::nullopt;
  return placed;
}

Result<std::size_t> LandmarkSurvey::store(bool finished) {
  std::size_t stored = 0;
  for (const MappedLandmark& landmark : mapper_.take_mapped(finished)) {
    for (const MappedPass& pass : stretch_.passes) {
      const RouteLine& segment = plan_.fused[pass.segment].line;
      const auto placed = placed_on(landmark, stretch_.line, pass, segment);
      if (!placed) continue;
      const auto tile = static_cast<std::uint32_t>(placed->landmark.along.from_m / tile_length_m_);
      const Status added = store_.add(pass.segment, tile, *placed);
      if (!added.ok()) return added.error();
      ++stored;
    }
  }
  return stored;
}

WitnessedPlace LandmarkSurvey::place_of(const AdjustedFrame& frame) const {
  WitnessedPlace place{{}, 0, frame.witness};
  for (const MappedPass& pass : stretch_.passes) {
    if (!pass.on_stretch.contains(frame.along_m)) continue;
    const FusedSegment& segment = plan_.fused[pass.segment];
    place.segment = segment.id;
    place.along_m =
        pass.is_line
            ? frame.along_m - pass.on_stretch.from_m
            : on_segment(frame.along_m, stretch_.line, pass.on_stretch, segment.line).along_m;
    break;
  }
  return place;
}

}  // namespace milepost
