#include "client/evaluate/road_truth.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace milepost {
namespace {

constexpr double kOffRoadM = 50;      // a position farther away is on no road
constexpr double kMaxTurnDeg = 75;    // of the recorded heading from the line's
constexpr double kMaxClimbM = 4;      // of the recorded altitude from the line's
constexpr double kAboutAsNearM = 1;   // than the nearest: the fix decides
constexpr double kPieceM = 20;        // of a line, in which its nearest points are told apart
constexpr double kReadAroundM = 300;  // surroundings that are read at once

// The nearest point of each piece of a line on which the frame may have been taken. Altitudes of
// some drives are of another origin than the map's: they decide only where that leaves a place.
std::vector<PlaceOnRoad> places_on(const SegmentKey& segment, const RouteLine& line,
                                   const Frame& frame, bool altitude_counts) {
  std::vector<PlaceOnRoad> places;
  const auto pieces = static_cast<int>(std::ceil(line.length_m() / kPieceM));
  for (int i = 0; i < pieces; ++i) {
    const double from_m = i * kPieceM;
    const AlongRange piece = {from_m, std::min(from_m + kPieceM, line.length_m())};
    const LineProjection beside = line.project(frame.position, piece);
    if (beside.distance_m > kOffRoadM) continue;
    const double heading_deg = line.heading_deg_at(beside.along_m);
    if (std::abs(turn_deg(heading_deg, frame.heading_deg)) > kMaxTurnDeg) continue;
    const double climb_m = frame.position.altitude_m - line.point_at(beside.along_m).altitude_m;
    if (altitude_counts && std::abs(climb_m) > kMaxClimbM) continue;
    places.push_back({segment, beside.along_m, beside.lateral_m, beside.distance_m});
  }
  return places;
}

// How far a fix is from a place along its segment; a fix on another segment is farther than any.
double apart_m(const PlaceOnRoad& place, const Fix& fix) {
  const bool is_there = fix.along_m && place.segment == SegmentKey{fix.version, fix.segment};
  return is_there ? std::abs(*fix.along_m - place.along_m)
                  : std::numeric_limits<double>::infinity();
}

}  // namespace

Result<const RouteLine*> RoadTruth::line_of(const SegmentKey& key) {
  const auto known = lines_.find(key);
  if (known != lines_.end()) return &known->second;
  const Result<SegmentDescription> segment = source_.segment(key.version, key.segment);
  if (!segment) return segment.error();
  Result<RouteLine> line = RouteLine::from_vertices(segment->vertices);
  if (!line) return line.error();
  return &lines_.emplace(key, std::move(*line)).first->second;
}

// Of builds that were replaced while the drive was localized only the fix knows.
Result<std::vector<SegmentKey>> RoadTruth::segments_around(const GeoPoint& position,
                                                           const MapVersion& version) {
  const bool is_known = known_radius_m_ >= 0 &&
                        geodesic_distance_m(known_around_, position) + kOffRoadM <= known_radius_m_;
  if (!is_known) {
    const auto near = source_.segments_near(position, kReadAroundM);
    if (!near) return near.error();
    known_.clear();
    for (const NearbySegment& segment : *near) known_.push_back({segment.version, segment.segment});
    known_around_ = position;
    known_radius_m_ = kReadAroundM;
  }
  std::vector<SegmentKey> around = known_;
  if (version.map.empty()) return around;
  std::erase_if(around, [&](const SegmentKey& key) {
    return key.version.map == version.map && key.version != version;
  });
  return around;
}

Result<std::optional<PlaceOnRoad>> RoadTruth::place_of(const Frame& frame, const Fix& fix) {
  auto around = segments_around(frame.position, fix.version);
  if (!around) return around.error();
  const SegmentKey fixed_on = {fix.version, fix.segment};
  if (fix.along_m && std::ranges::find(*around, fixed_on) == around->end())
    around->push_back(fixed_on);
  std::vector<PlaceOnRoad> places;
  for (const bool altitude_counts : {true, false}) {
    for (const SegmentKey& key : *around) {
      const Result<const RouteLine*> line = line_of(key);
      if (!line) return line.error();
      std::ranges::move(places_on(key, **line, frame, altitude_counts), std::back_inserter(places));
    }
    if (!places.empty()) break;
  }
  if (places.empty()) return std::optional<PlaceOnRoad>();
  const double nearest_m =
      std::ranges::min_element(places, {}, &PlaceOnRoad::distance_m)->distance_m;
  const auto is_better = [&](const PlaceOnRoad& a, const PlaceOnRoad& b) {
    const double a_apart_m = apart_m(a, fix);
    const double b_apart_m = apart_m(b, fix);
    return a_apart_m != b_apart_m ? a_apart_m < b_apart_m : a.distance_m < b.distance_m;
  };
  std::erase_if(places, [&](const PlaceOnRoad& place) {
    return place.distance_m > nearest_m + kAboutAsNearM;
  });
  // On each segment the nearest point stands for its pieces, unless the line passes twice.
  const std::vector<PlaceOnRoad> all = places;
  std::erase_if(places, [&](const PlaceOnRoad& place) {
    return std::ranges::any_of(all, [&](const PlaceOnRoad& other) {
      return other.segment == place.segment && other.distance_m < place.distance_m &&
             std::abs(other.along_m - place.along_m) < 2 * kPieceM;
    });
  });
  return std::optional(*std::ranges::min_element(places, is_better));
}

}  // namespace milepost
