#include "tests/client/fetch/fake_map.h"

#include <random>
#include <sstream>

#include <nlohmann/json.hpp>

#include "schema/base/digest.h"
#include "schema/feature/types.h"

namespace milepost::testing {
namespace {

using nlohmann::json;

constexpr std::uint32_t kTiles = 10;

constexpr std::uint32_t kCells = 9;

std::string text_of(const Bytes& bytes) { return std::string(as_text(bytes)); }

Bytes random_bytes(std::size_t size, std::uint32_t seed) {
  std::mt19937 random(seed);
  Bytes bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

}  // namespace

FakeMap::FakeMap() {
  for (std::uint32_t k = 0; k < kTiles; ++k) {
    const Bytes bytes = encoded_tile(k);
    index.push_back({k, {20.0 * k, 20.0 * k + 25}, 10, bytes.size(), digest_of(bytes)});
  }
  for (std::uint32_t k = 0; k < kCells; ++k) {
    const Bytes bytes = encoded_cell(k);
    const GridCell cell{27800 + k / 3, 37680 + k % 3};
    cells.push_back({cell.number(), 10, bytes.size(), digest_of(bytes)});
  }
}

Bytes FakeMap::encoded_tile(std::uint32_t index_of_tile) const {
  return random_bytes(1000 + 10 * index_of_tile, index_of_tile + 1);
}

Bytes FakeMap::encoded_cell(std::uint32_t k) const { return random_bytes(500 + 10 * k, k + 101); }

std::string FakeMap::catalog_document() const {
  return json{{"maps", {{{"name", "town"}, {"build", build}}}}}.dump();
}

std::string FakeMap::map_document() const {
  return json{
      {"name", "town"},
      {"build", build},
      {"layers", {"tracklets", "walls"}},
      {"layer_parameters",
       {{"tracklets", {{"items", "tracklets"}, {"focal_px", {400, 900}}}},
        {"walls", {{"items", "walls"}}}}},
      {"feature", to_json(FeatureParameters())},
      {"bounds", {{"west_deg", 8.4}, {"south_deg", 49}, {"east_deg", 8.4}, {"north_deg", 49.0018}}},
      {"segments", {"s1"}},
      {"length_m", 200}}
      .dump();
}

std::string FakeMap::segment_document() const {
  json tiles = json::array();
  for (const TileEntry& entry : index) {
    tiles.push_back({{"index", entry.index},
                     {"from_m", entry.along.from_m},
                     {"to_m", entry.along.to_m},
                     {"items", entry.items},
                     {"bytes", entry.bytes},
                     {"digest", entry.digest}});
  }
  return json{{"map", "town"},
              {"build", build},
              {"segment", "s1"},
              {"length_m", 200},
              {"line", {{49.0, 8.4, 110, 0}, {49.0009, 8.4, 110, 100}, {49.0018, 8.4, 111, 200}}},
              {"successors", {"s2"}},
              {"tiles", {{"tracklets", tiles}}}}
      .dump();
}

std::string FakeMap::areas_document() const {
  json walls = json::array();
  for (const CellEntry& entry : cells) {
    const Bounds bounds = GridCell::numbered(entry.cell).bounds();
    walls.push_back({{"cell", entry.cell},
                     {"west_deg", bounds.west_deg},
                     {"south_deg", bounds.south_deg},
                     {"east_deg", bounds.east_deg},
                     {"north_deg", bounds.north_deg},
                     {"items", entry.items},
                     {"bytes", entry.bytes},
                     {"digest", entry.digest}});
  }
  return json{{"map", "town"}, {"build", build}, {"cells", {{"walls", walls}}}}.dump();
}

std::string FakeMap::near_document() const {
  const json entry = {{"map", "town"},   {"build", build},     {"segment", "s1"},
                      {"along_m", 50.0}, {"distance_m", 1.25}, {"length_m", 200}};
  return json{{"segments", {entry}}}.dump();
}

std::string FakeMap::range_body(const AlongRange& range) const {
  std::string body;
  for (const TileEntry& entry : index) {
    if (entry.along.meets(range)) body += text_of(encoded_tile(entry.index));
  }
  return body;
}

std::string FakeMap::box_body(const Bounds& box) const {
  std::string body;
  for (std::uint32_t k = 0; k < cells.size(); ++k) {
    if (GridCell::numbered(cells[k].cell).bounds().meets(box)) body += text_of(encoded_cell(k));
  }
  return body;
}

ScriptedAnswer FakeMap::answer(const std::string& target) const {
  const std::string segment = "/v1/maps/town/builds/" + build + "/segments/s1";
  const std::string areas = "/v1/maps/town/builds/" + build + "/areas";
  const auto ok = [](std::string body) { return ScriptedAnswer{.body = std::move(body)}; };
  if (target == "/v1/maps") return ok(catalog_document());
  if (target == "/v1/maps/town") return ok(map_document());
  if (target == areas) return ok(areas_document());
  if (target == segment) return ok(segment_document());
  if (target.starts_with("/v1/segments?")) return ok(near_document());
  if (const auto range = range_of(target)) return ok(range_body(*range));
  const std::string tile = segment + "/tiles/tracklets/";
  if (target.starts_with(tile)) {
    return ok(
        text_of(encoded_tile(static_cast<std::uint32_t>(std::stoul(target.substr(tile.size()))))));
  }
  if (const auto box = box_of(target)) return ok(box_body(*box));
  for (std::uint32_t k = 0; k < cells.size(); ++k) {
    if (target == areas + "/walls/" + std::to_string(cells[k].cell)) {
      return ok(text_of(encoded_cell(k)));
    }
  }
  return problem(404, "no such thing");
}

ScriptedAnswer problem(int status, const std::string& detail) {
  return {.status = status,
          .body = json{{"type", "about:blank"}, {"status", status}, {"detail", detail}}.dump(),
          .headers = {{"Content-Type", "application/problem+json"}}};
}

std::optional<AlongRange> range_of(const std::string& target) {
  const auto number = [&](const std::string& key) {
    return std::stod(target.substr(target.find(key) + key.size()));
  };
  if (target.find("/tiles?layer=tracklets&from_m=") == std::string::npos) return std::nullopt;
  return AlongRange{number("from_m="), number("to_m=")};
}

std::optional<Bounds> box_of(const std::string& target) {
  const std::size_t at = target.find("/areas/walls?bbox=");
  if (at == std::string::npos) return std::nullopt;
  std::istringstream numbers(target.substr(target.find('=', at) + 1));
  Bounds box;
  char comma = 0;
  numbers >> box.west_deg >> comma >> box.south_deg >> comma >> box.east_deg >> comma >>
      box.north_deg;
  return box;
}

bool is_tile_target(const std::string& target) {
  return target.find("/tiles") != std::string::npos;
}

bool is_cell_target(const std::string& target) {
  return target.find("/areas/") != std::string::npos;
}

}  // namespace milepost::testing
