#include "mapper/export/geojson.h"

#include <cmath>
#include <utility>
#include <vector>

#include "schema/base/json.h"
#include "schema/tile/codec.h"
#include "schema/tile/layer_parameters.h"

namespace milepost {
namespace {

using Json = nlohmann::ordered_json;
using Position = std::vector<double>;  // longitude, latitude and perhaps altitude
using Positions = std::vector<Position>;

// Where the shorter way from `from` to `to` crosses longitude 180: the position on the side of
// `from`.
Position at_180(const Position& from, const Position& to) {
  const double side_deg = std::copysign(180.0, from[0]);
  const double way_deg = to[0] + 2 * side_deg - from[0];
  const double part = way_deg == 0 ? 1 : (side_deg - from[0]) / way_deg;
  Position cut = {side_deg};
  for (std::size_t i = 1; i < from.size(); ++i) cut.push_back(from[i] + part * (to[i] - from[i]));
  return cut;
}

// The parts of a line on either side of longitude 180 (RFC 7946, 3.1.9).
std::vector<Positions> cut_at_180(const Positions& line) {
  std::vector<Positions> parts = {{line.front()}};
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (std::abs(line[i][0] - line[i - 1][0]) > 180) {
      Position cut = at_180(line[i - 1], line[i]);
      if (cut != line[i - 1]) parts.back().push_back(cut);
      cut[0] = -cut[0];
      parts.emplace_back();
      if (cut != line[i]) parts.back().push_back(std::move(cut));
    }
    parts.back().push_back(line[i]);
  }
  if (parts.size() > 1) {  // a line that only touches longitude 180 has a part of one position
    std::erase_if(parts, [](const Positions& part) { return part.size() < 2; });
  }
  return parts;
}

Json geometry_of(const Positions& line) {
  const std::vector<Positions> parts = cut_at_180(line);
  if (parts.size() == 1) return {{"type", "LineString"}, {"coordinates", parts.front()}};
  return {{"type", "MultiLineString"}, {"coordinates", parts}};
}

// Serializes features one by one, so that a large map is never held as a JSON tree.
class FeatureCollection {
 public:
  void add(const Positions& line, Json properties) {
    const Json feature = {{"type", "Feature"},
                          {"geometry", geometry_of(line)},
                          {"properties", std::move(properties)}};
    text_ += features_ == 0 ? "\n" : ",\n";
    text_ += feature.dump();
    ++features_;
  }

  GeoJson finish() && { return {std::move(text_) + "\n]}\n", features_}; }

 private:
  std::string text_ = R"({"type":"FeatureCollection","features":[)";
  std::size_t features_ = 0;
};

Positions positions_of(const std::vector<StoredVertex>& vertices) {
  Positions positions;
  for (const StoredVertex& vertex : vertices) {
    positions.push_back({vertex.longitude_deg, vertex.latitude_deg, vertex.altitude_m});
  }
  return positions;
}

// Each with the name of its map: `own_map` for those of the map itself.
nlohmann::ordered_json successors_json(const std::vector<Successor>& successors,
                                       const std::string& own_map) {
  auto list = nlohmann::ordered_json::array();
  for (const Successor& successor : successors) {
    list.push_back(
        {{"map", successor.map.empty() ? own_map : successor.map}, {"segment", successor.segment}});
  }
  return list;
}

nlohmann::ordered_json passes_json(const std::vector<StoredPass>& passes) {
  auto list = nlohmann::ordered_json::array();
  for (const StoredPass& pass : passes) {
    list.push_back({{"drive", pass.drive}, {"from_m", pass.from_m}, {"to_m", pass.to_m}});
  }
  return list;
}

Position position_of(const WallEnd& end) { return {end.longitude_deg, end.latitude_deg}; }

// The possible values of --layer, for messages.
std::string layers_of(const MapReader& map) {
  std::string names = kSegments;
  for (const auto& [layer, parameters] : map.layers()) names += ", " + layer;
  return names;
}

Status check_holds_walls(const MapReader& map, const std::string& layer) {
  const auto found = map.layers().find(layer);
  if (found == map.layers().end()) {
    return Error{ErrorCode::not_found, map.file().string(), "the map has no layer '" + layer + "'",
                 "choose among those that it has: " + layers_of(map)};
  }
  const Result<nlohmann::json> parameters = read_json(found->second);
  const std::string items = parameters ? items_named_in(*parameters) : "";
  if (items == kWallItems) return ok_status();
  return Error{ErrorCode::invalid_input, map.file().string(),
               "the layer '" + layer + "' does not hold walls: its items are '" + items + "'",
               "export a layer of walls, or segments"};
}

}  // namespace

Result<GeoJson> segments_geojson(const MapReader& map) {
  FeatureCollection collection;
  for (const std::string& id : map.segment_ids()) {
    const Result<StoredSegment> segment = map.segment(id);
    if (!segment.ok()) return segment.error();
    if (segment->vertices.size() < 2) {
      return Error{ErrorCode::corrupt, map.file().string() + ", segment " + id,
                   "a line needs two or more vertices", "rebuild the map"};
    }
    nlohmann::ordered_json properties = {
        {"id", id},
        {"length_m", segment->length_m},
        {"successors", successors_json(segment->successors, map.file().stem().string())},
        {"passes", passes_json(segment->passes)}};
    if (const PositionError& error = segment->position_error; error.sigma_m) {
      properties["position_sigma_m"] = *error.sigma_m;
      properties["assumed"] = error.is_assumed;
    }
    collection.add(positions_of(segment->vertices), std::move(properties));
  }
  return std::move(collection).finish();
}

Result<GeoJson> walls_geojson(const MapReader& map, const std::string& layer) {
  const Status checked = check_holds_walls(map, layer);
  if (!checked.ok()) return checked.error();
  const Result<std::vector<CellEntry>> cells = map.cell_index(layer);
  if (!cells.ok()) return cells.error();
  std::vector<WallTile> tiles;
  for (const CellEntry& entry : *cells) {
    const Result<Bytes> frame = map.cell(layer, entry.cell);
    if (!frame.ok()) return frame.error();
    Result<WallTile> tile = decode_walls(*frame);
    if (!tile.ok()) {
      return Error{
          ErrorCode::corrupt,
          map.file().string() + ", layer " + layer + ", cell " + std::to_string(entry.cell),
          tile.error().what, tile.error().hint};
    }
    tiles.push_back(std::move(*tile));
  }
  FeatureCollection collection;
  for (const Wall& wall : walls_of(tiles)) {
    collection.add({position_of(wall.begin), position_of(wall.end)}, {{"sigma_m", wall.sigma_m}});
  }
  return std::move(collection).finish();
}

}  // namespace milepost
