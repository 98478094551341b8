#include "tests/mapper/report/made_up_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include <nlohmann/json.hpp>

#include "mapper/codebook/codebook.h"
#include "schema/tile/codec.h"
#include "schema/tile/layer_parameters.h"

namespace milepost::testing {
namespace {

constexpr double kTileM = 20;
constexpr double kApartM = 0.25;  // between the begins of landmarks

StoredSegment stored(const MadeUpSegment& made) {
  const LocalFrame frame({49, 8.4, 110});
  StoredSegment segment{made.id, 0, {}, {}, made.passes, made.position_error};
  for (const double north_m : {0.0, made.length_m}) {
    const GeoPoint at = frame.geo_from_enu({made.east_m, north_m, 0});
    if (!segment.vertices.empty())
      segment.length_m = geodesic_distance_m({49, segment.vertices.front().longitude_deg, 0}, at);
    segment.vertices.push_back(
        {at.latitude_deg, at.longitude_deg, at.altitude_m, segment.length_m});
  }
  return segment;
}

// Landmarks on both sides of the road, 15 m ahead of where they are last seen.
Landmark landmark_from(double along_m, double origin_m, const MadeUpSegment& made, int number) {
  Landmark landmark;
  landmark.along = {along_m, std::min(along_m + made.seen_over_m, made.length_m)};
  landmark.position = {number % 2 == 0 ? 5.0 : -4.0, landmark.along.to_m + 15 - origin_m,
                       static_cast<double>(number % 5)};
  landmark.depth_sigma_m = 0.1F;
  landmark.size_m = 0.2F;
  landmark.size_sigma = 0.1F;
  landmark.observations = 10;
  landmark.passes = made.landmark_passes;
  return landmark;
}

void add_tiles(MapWriter& map, const MadeUpSegment& made) {
  std::map<std::uint32_t, LandmarkTile> tiles;
  int number = 0;
  for (const AlongRange& range : made.mapped) {
    for (double along_m = range.from_m; along_m < range.to_m - 0.01; along_m += kApartM) {
      const auto index = static_cast<std::uint32_t>(along_m / kTileM);
      auto& tile =
          tiles.try_emplace(index, LandmarkTile{made.id, index, index * kTileM, {}}).first->second;
      tile.landmarks.push_back(landmark_from(along_m, tile.origin_m, made, number++));
    }
  }
  for (const auto& [index, tile] : tiles) {
    const LandmarkTile kept = quantized(tile);
    EXPECT_TRUE(map.add_tile(made.id, layers::kLandmarks, index, kept.along(),
                             kept.landmarks.size(), encode_landmarks(kept))
                    .ok());
  }
}

}  // namespace

MapReportData made_up_report(const std::vector<MadeUpSegment>& segments,
                             const std::optional<MappingRecord>& record) {
  const TempFolder folder;
  Result<MapWriter> map = MapWriter::create(folder / "town.map");
  EXPECT_TRUE(map.ok());
  LayerParameters parameters;
  parameters.items = LayerItems::landmarks;
  parameters.tile_length_m = kTileM;
  parameters.focal_x_px = parameters.focal_y_px = 500;
  parameters.projection = shipped_codebook();
  EXPECT_TRUE(map->add_layer(layers::kLandmarks, to_json(parameters).dump()).ok());
  for (const MadeUpSegment& made : segments) {
    EXPECT_TRUE(map->add_segment(stored(made)).ok());
    add_tiles(*map, made);
  }
  EXPECT_TRUE(map->finish().ok());
  const Result<MapReader> reader = MapReader::open(folder / "town.map");
  EXPECT_TRUE(reader.ok());
  Result<MapReportData> data = map_report_data(*reader, record);
  EXPECT_TRUE(data.ok()) << data.error().line();
  return std::move(*data);
}

}  // namespace milepost::testing
