#include "client/localize/landmark_window.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace milepost {
namespace {

Eigen::Vector3d vector_from(const EnuPoint& point) {
  return {point.east_m, point.north_m, point.up_m};
}

// Whether descriptors of two layers can be compared.
bool are_comparable(const SegmentLayer& a, const SegmentLayer& b) {
  if (a.build == b.build) return true;
  return a.feature() == b.feature() && a.parameters().projection == b.parameters().projection;
}

bool is_same_place(const UnrolledSegment& a, const UnrolledSegment& b) {
  constexpr double kSameM = 1e-9;
  return a.layer == b.layer && std::abs(a.offset_m - b.offset_m) < kSameM && a.side == b.side &&
         a.is_main_way == b.is_main_way;
}

}  // namespace

LandmarkWindow::LandmarkWindow(const WindowReach& reach, const GeoPoint& origin)
    : reach_(reach), frame_(origin) {}

Covered LandmarkWindow::cover(const HeldMap& held, const std::vector<UnrolledSegment>& road,
                              const AlongRange& range) {
  Covered covered;
  std::vector<Part> parts;
  for (const UnrolledSegment& segment : road) {
    const bool is_of_use =
        segment.side != RoadSide::beside && are_comparable(*segment.layer, *road.front().layer);
    if (!is_of_use) continue;
    const auto known = std::ranges::find_if(
        parts_, [&](const Part& part) { return part.segment.layer == segment.layer; });
    const bool is_new = known == parts_.end();
    Part part = is_new ? Part{segment, TileWindow<LandmarkTile>(segment.layer->key, reach_)}
                       : std::move(*known);
    covered.changed |= is_new || !is_same_place(part.segment, segment);
    part.segment = segment;
    const Covered of_part = part.tiles.cover(held, range.shifted(-segment.offset_m));
    covered.changed |= of_part.changed;
    covered.complete &= of_part.complete;
    if (!covered.failure) covered.failure = of_part.failure;
    parts.push_back(std::move(part));
  }
  covered.changed |= parts.size() != parts_.size();
  parts_ = std::move(parts);
  if (covered.changed) rebuild();
  return covered;
}

void LandmarkWindow::set_origin(const GeoPoint& origin) {
  frame_ = LocalFrame(origin);
  rebuild();
}

// A track that was observed from two segments is stored in both: it is taken once.
void LandmarkWindow::rebuild() {
  landmarks_.clear();
  std::set<CompactDescriptor> taken;
  for (const Part& part : parts_) {
    const RouteLine& line = part.segment.layer->line;
    part.tiles.for_each([&](const LandmarkTile& tile) {
      const LocalFrame tile_frame(line.point_at(tile.origin_m));
      for (const Landmark& landmark : tile.landmarks) {
        if (parts_.size() > 1) {
          const bool is_first = taken.insert(landmark.descriptor).second;
          if (!is_first && part.segment.side != RoadSide::current) continue;
        }
        landmarks_.push_back(placed(landmark, tile_frame, part.segment));
      }
    });
  }
}

LocalLandmark LandmarkWindow::placed(const Landmark& landmark, const LocalFrame& tile_frame,
                                     const UnrolledSegment& segment) const {
  const RouteLine& line = segment.layer->line;
  LocalLandmark placed;
  placed.descriptor = landmark.descriptor;
  placed.enu_m = vector_from(frame_.enu_from_geo(tile_frame.geo_from_enu(landmark.position)));
  const double middle_m = std::min(landmark.along.middle_m(), line.length_m());
  const double heading_rad = line.heading_deg_at(middle_m) * kRadPerDeg;
  const Eigen::Vector3d to_the_right(std::cos(heading_rad), -std::sin(heading_rad), 0);
  const Eigen::Vector3d mapped_from =
      vector_from(frame_.enu_from_geo(line.point_at(middle_m))) + landmark.right_m * to_the_right;
  const Eigen::Vector3d from_there = placed.enu_m - mapped_from;
  placed.mapping_ray = from_there.normalized();
  placed.mapped_at_m = middle_m + segment.offset_m;
  placed.mapped_ahead_m =
      from_there.x() * std::sin(heading_rad) + from_there.y() * std::cos(heading_rad);
  placed.depth_sigma_m = landmark.depth_sigma_m;
  placed.size_m = landmark.size_m;
  placed.size_sigma = landmark.size_sigma;
  placed.along = landmark.along.shifted(segment.offset_m);
  placed.is_of_this_way = segment.side == RoadSide::current ||
                          (segment.side == RoadSide::behind && segment.is_main_way);
  return placed;
}

}  // namespace milepost
