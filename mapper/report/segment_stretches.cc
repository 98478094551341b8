#include "mapper/report/segment_stretches.h"

#include <algorithm>
#include <cmath>

namespace milepost {
namespace {

constexpr double kPlaceM = 2;  // between the places of a stretch that are looked at

Eigen::Vector3d vector_of(const EnuPoint& enu) { return {enu.east_m, enu.north_m, enu.up_m}; }

// What a camera on the line sees of landmarks.
struct Place {
  LocalFrame frame;
  double heading_rad;

  // East, north, up to ahead, right, up.
  Eigen::Vector3d turned(const Eigen::Vector3d& enu) const {
    const double s = std::sin(heading_rad);
    const double c = std::cos(heading_rad);
    return {enu.x() * s + enu.y() * c, enu.x() * c - enu.y() * s, enu.z()};
  }
};

struct Sight {
  int landmarks = 0;
  int repeated = 0;
  FixSigma sigma;
};

Sight sight_at(double along_m, const StretchInput& input) {
  const Place place{LocalFrame(input.line.point_at(along_m)),
                    input.line.heading_deg_at(along_m) * kRadPerDeg};
  const FixSettings settings;
  const auto passes_there = static_cast<double>(input.segment.passes.size());
  Sight sight;
  std::vector<SightedLandmark> seen;
  for (const PlacedLandmark& each : input.landmarks) {
    const Landmark& landmark = each.landmark;
    if (!landmark.along.contains(along_m)) continue;
    const Eigen::Vector3d at = vector_of(place.frame.enu_from_geo(each.position));
    const Eigen::Vector3d from = vector_of(place.frame.enu_from_geo(each.mapped_from));
    ++sight.landmarks;
    if (landmark.passes > 1) ++sight.repeated;
    seen.push_back({place.turned(at), place.turned((at - from).normalized()),
                    landmark.depth_sigma_m, landmark.size_m, landmark.size_sigma,
                    probability_of_sight(landmark.observations, landmark.passes, passes_there,
                                         settings.half_repeated_at)});
  }
  sight.sigma = fix_sigma(seen, input.focal_px, settings);
  return sight;
}

void look_around(MapStretch& stretch, const StretchInput& input) {
  bool is_first = true;
  const auto places = std::max(1L, std::lround(stretch.length_m() / kPlaceM));
  for (long k = 0; k < places; ++k) {
    const double along_m = stretch.along.from_m + (static_cast<double>(k) + 0.5) *
                                                      stretch.length_m() /
                                                      static_cast<double>(places);
    const Sight sight = sight_at(along_m, input);
    if (is_first || sight.landmarks < stretch.in_sight) {
      stretch.in_sight = sight.landmarks;
      stretch.repeated = sight.repeated;
    }
    if (is_first || sight.sigma.worse_m() > stretch.sigma_map->worse_m())
      stretch.sigma_map = sight.sigma;
    is_first = false;
  }
  if (stretch.in_sight == 0) stretch.sigma_map = std::nullopt;
  const std::optional<double>& of_map = input.segment.position_error.sigma_m;
  if (stretch.sigma_map && of_map)
    stretch.sigma_world_m = std::hypot(stretch.sigma_map->worse_m(), *of_map);
}

bool is_mostly_in(const AlongRange& range, const std::vector<AlongRange>& gaps) {
  double inside_m = 0;
  for (const AlongRange& gap : gaps) {
    if (!gap.meets(range)) continue;
    inside_m += std::min(gap.to_m, range.to_m) - std::max(gap.from_m, range.from_m);
  }
  return inside_m >= (range.to_m - range.from_m) / 2;
}

std::size_t index_of(double along_m, std::size_t count) {
  return static_cast<std::size_t>(
      std::clamp(std::floor(along_m / kStretchM), 0.0, static_cast<double>(count) - 1));
}

}  // namespace

std::vector<PlacedLandmark> placed(const LandmarkTile& tile, const RouteLine& line) {
  const LocalFrame tile_frame(line.point_at(tile.origin_m));
  std::vector<PlacedLandmark> all;
  all.reserve(tile.landmarks.size());
  for (const Landmark& landmark : tile.landmarks) {
    const double middle_m = std::min(landmark.along.middle_m(), line.length_m());
    const double heading_rad = line.heading_deg_at(middle_m) * kRadPerDeg;
    const LocalFrame middle(line.point_at(middle_m));
    const EnuPoint beside{landmark.right_m * std::cos(heading_rad),
                          -landmark.right_m * std::sin(heading_rad), 0};
    PlacedLandmark each{landmark, tile_frame.geo_from_enu(landmark.position),
                        middle.geo_from_enu(beside)};
    each.distance_m = (vector_of(middle.enu_from_geo(each.position)) - vector_of(beside)).norm();
    all.push_back(each);
  }
  return all;
}

std::vector<MapStretch> stretches_of(const StretchInput& input) {
  const double length_m = input.segment.length_m;
  const auto count = static_cast<std::size_t>(std::max(1L, std::lround(length_m / kStretchM)));
  std::vector<MapStretch> stretches(count);
  for (std::size_t k = 0; k < count; ++k) {
    MapStretch& stretch = stretches[k];
    stretch.along = {static_cast<double>(k) * kStretchM,
                     k + 1 == count ? length_m : static_cast<double>(k + 1) * kStretchM};
    stretch.has_gap = is_mostly_in(stretch.along, input.gaps);
    look_around(stretch, input);
  }
  for (const PlacedLandmark& each : input.landmarks)
    ++stretches[index_of(each.landmark.along.from_m, count)].landmarks;
  for (const StretchFit& fit : input.fits)
    stretches[index_of(fit.from_m, count)].fits.push_back(fit);
  return stretches;
}

}  // namespace milepost
