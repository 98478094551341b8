#include "tests/client/localize/landmark_road.h"

#include <cmath>
#include <map>
#include <numbers>

#include <nlohmann/json.hpp>

#include "schema/geo/geodesy.h"
#include "schema/tile/codec.h"

namespace milepost::testing {
namespace {

constexpr GeoPoint kStart = {49, 8.4, 110};
constexpr double kBendFromM = 200;
constexpr double kBendRadiusM = 80;
constexpr double kSlope = 0.03;
constexpr double kDescriptorStep = 0.01;
constexpr double kMappedFromM = 45;  // ahead of a landmark ...
constexpr double kMappedToM = 8;     // ... down to this distance
constexpr double kFarthestSeenM = 50;
const MapVersion kVersion = {"map", "0123456789abcdef0123456789abcdef"};

// In the tangent frame at the start.
EnuPoint road_point(double along_m) {
  const double into_bend_m =
      std::clamp(along_m - kBendFromM, 0.0, kBendRadiusM * std::numbers::pi / 2);
  const double turned_rad = into_bend_m / kBendRadiusM;
  const double east_m = std::max(0.0, along_m - kBendFromM - into_bend_m);
  const double north_m = std::min(along_m, kBendFromM);
  return {east_m + kBendRadiusM * (1 - std::cos(turned_rad)),
          north_m + kBendRadiusM * std::sin(turned_rad), kSlope * along_m};
}

RouteLine road_line() {
  std::vector<GeoPoint> vertices;
  const LocalFrame frame(kStart);
  for (double along_m = 0; along_m <= LandmarkRoad::kLengthM; along_m += 1) {
    vertices.push_back(frame.geo_from_enu(road_point(along_m)));
  }
  return *RouteLine::from_vertices(vertices);
}

// The point `lateral_m` to the right of the line and `up_m` above it, extended straight beyond its
// ends.
GeoPoint beside(const RouteLine& line, double along_m, double lateral_m, double up_m) {
  const double on_line_m = std::clamp(along_m, 0.0, line.length_m());
  const double ahead_m = along_m - on_line_m;
  const double heading_rad = line.heading_deg_at(on_line_m) * kRadPerDeg;
  const double c = std::cos(heading_rad);
  const double s = std::sin(heading_rad);
  return LocalFrame(line.point_at(on_line_m))
      .geo_from_enu(
          {lateral_m * c + ahead_m * s, -lateral_m * s + ahead_m * c, up_m + kSlope * ahead_m});
}

Eigen::Vector3d vector_from(const EnuPoint& point) {
  return {point.east_m, point.north_m, point.up_m};
}

}  // namespace

LandmarkRoad::LandmarkRoad()
    : line_(road_line()),
      projection_(PcaProjection::trained(unlike_descriptors(500, 1), kDescriptorStep)) {
  constexpr double kSpacingM = 0.5;
  const auto descriptors = unlike_descriptors(static_cast<std::size_t>(kLengthM / kSpacingM), 2);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> out_m(4, 14);
  std::uniform_real_distribution<double> up_m(-1, 5);
  std::uniform_real_distribution<double> size_m(0.1, 0.4);
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    const double along_m = kMappedToM + kSpacingM * static_cast<double>(i);
    if (along_m > line_.length_m()) break;
    const double lateral_m = out_m(random) * (i % 2 == 0 ? 1 : -1);
    things_.push_back(
        {beside(line_, along_m, lateral_m, up_m(random)), along_m, size_m(random), descriptors[i]});
  }
}

RouteLine LandmarkRoad::line_of(const AlongRange& part) const {
  const auto first = line_.vertices().begin() + std::lround(part.from_m);
  const auto last = line_.vertices().begin() + std::lround(part.to_m);
  return *RouteLine::from_vertices({first, last + 1});
}

std::vector<LandmarkTile> LandmarkRoad::tiles(const std::string& segment,
                                              const AlongRange& part) const {
  const RouteLine line = line_of(part);
  std::map<std::uint32_t, LandmarkTile> tiles;
  for (const Thing& thing : things_) {
    const AlongRange seen = {std::max(0.0, thing.along_m - kMappedFromM),
                             thing.along_m - kMappedToM};
    if (seen.to_m < part.from_m || seen.from_m > part.to_m) continue;
    const AlongRange along = {std::max(seen.from_m, part.from_m) - part.from_m,
                              seen.to_m - part.from_m};
    const auto index = static_cast<std::uint32_t>(along.from_m / kTileM);
    LandmarkTile& tile = tiles[index];
    tile.segment = segment;
    tile.index = index;
    tile.origin_m = index * kTileM;
    Landmark landmark;
    landmark.descriptor = projection_.compact(thing.descriptor);
    landmark.position = LocalFrame(line.point_at(tile.origin_m)).enu_from_geo(thing.position);
    landmark.depth_sigma_m = 0.05F;
    landmark.size_m = static_cast<float>(thing.size_m);
    landmark.size_sigma = 0.05F;
    landmark.along = along;
    landmark.observations = 10;
    tile.landmarks.push_back(landmark);
  }
  std::vector<LandmarkTile> all;
  for (const auto& [index, tile] : tiles) all.push_back(quantized(tile));
  return all;
}

Camera LandmarkRoad::query_camera() const { return {kWidthPx, kHeightPx, kCamera}; }

double LandmarkRoad::course_deg(const RoadPose& at) const {
  return wrapped_360(line_.heading_deg_at(at.along_m) + at.yaw_deg);
}

FeatureSet LandmarkRoad::observe(const RoadPose& at, double mounting_deg,
                                 std::mt19937& random) const {
  const LocalFrame frame(beside(line_, at.along_m, at.lateral_m, 0));
  CameraPose pose;
  pose.heading_rad = (course_deg(at) + mounting_deg) * kRadPerDeg;
  pose.pitch_rad = std::atan(kSlope);
  std::normal_distribution<double> noise;
  FeatureSet set;
  for (const Thing& thing : things_) {
    if (std::abs(thing.along_m - at.along_m) > kFarthestSeenM) continue;
    const Eigen::Vector3d seen =
        milepost::point_in_camera(pose, vector_from(frame.enu_from_geo(thing.position)));
    if (seen.z() < 2 || seen.z() > kFarthestSeenM) continue;
    const Eigen::Vector2d pixel = kCamera.project(seen);
    if (pixel.x() < 0 || pixel.x() > kWidthPx || pixel.y() < 0 || pixel.y() > kHeightPx) continue;
    const double scale_px = thing.size_m * kCamera.focal_px() / seen.z();
    set.features.push_back({static_cast<float>(pixel.x() + 0.5 * noise(random)),
                            static_cast<float>(pixel.y() + 0.5 * noise(random)),
                            static_cast<float>(scale_px * std::exp(0.05 * noise(random)))});
    set.descriptors.push_back(thing.descriptor);
  }
  return set;
}

const LandmarkRoad& shared_road() {
  static const LandmarkRoad road;
  return road;
}

LocalizerSettings settings_of_a_short_reach() {
  LocalizerSettings settings;
  settings.prefetch_m = 0;
  settings.provider.kept_m = 0;
  settings.provider.backoff.first_s = 0.001;
  return settings;
}

namespace {

std::shared_ptr<MemorySource> empty_map(const LandmarkRoad& road) {
  const nlohmann::json parameters = {
      {"items", "landmarks"}, {"focal_px", {700, 700}}, {"codebook", road.projection().to_json()}};
  return std::make_shared<MemorySource>(kVersion, "tracklets", parameters);
}

std::string id_from(double from_m) { return "road-" + std::to_string(std::lround(from_m)); }

void add_segment(MemorySource& map, const LandmarkRoad& road, const std::string& id,
                 const AlongRange& part, const std::vector<Successor>& successors) {
  std::vector<MemorySource::Tile> tiles;
  for (const LandmarkTile& tile : road.tiles(id, part))
    tiles.push_back({tile.along(), encode_landmarks(tile)});
  const RouteLine line = road.line_of(part);
  map.add({id, line.length_m(), line.vertices(), successors}, std::move(tiles));
}

}  // namespace

std::shared_ptr<MemorySource> map_of(const LandmarkRoad& road) {
  auto map = empty_map(road);
  add_segment(*map, road, "road", {0, LandmarkRoad::kLengthM}, {});
  return map;
}

std::shared_ptr<MemorySource> map_of(const LandmarkRoad& road, const std::vector<double>& cuts_m) {
  constexpr double kOverlapM = 5;
  auto map = empty_map(road);
  double from_m = 0;
  for (std::size_t i = 0; i <= cuts_m.size(); ++i) {
    const std::string id = id_from(from_m);
    if (i == cuts_m.size()) {
      add_segment(*map, road, id, {from_m, LandmarkRoad::kLengthM}, {});
      break;
    }
    add_segment(*map, road, id, {from_m, cuts_m[i] + kOverlapM},
                {{id_from(cuts_m[i]), kVersion.map}});
    from_m = cuts_m[i];
  }
  return map;
}

std::shared_ptr<MemorySource> map_of_parts(const LandmarkRoad& road,
                                           const std::vector<AlongRange>& parts) {
  auto map = empty_map(road);
  for (const AlongRange& part : parts) add_segment(*map, road, id_from(part.from_m), part, {});
  return map;
}

void wait_for_tiles(Localizer& localizer, double timestamp_s) {
  constexpr std::chrono::seconds kLongest(30);
  localizer.wait_for_tiles(timestamp_s, std::chrono::steady_clock::now() + kLongest);
}

}  // namespace milepost::testing
