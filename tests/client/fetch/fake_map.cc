#include "tests/client/fetch/fake_map.h"

#include <random>
#include <sstream>

#include <nlohmann/json.hpp>

#include "schema/base/digest.h"
#include "schema/document/manifest.h"
#include "schema/document/map_documents.h"
#include "schema/feature/types.h"

namespace milepost::testing {
namespace {

using nlohmann::json;

constexpr std::uint32_t kTiles = 10;

constexpr std::uint32_t kCells = 9;

constexpr const char* kTracklets = R"({"items": "tracklets", "focal_px": [400, 900]})";
constexpr const char* kWalls = R"({"items": "walls"})";

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

std::string FakeMap::build() const { return digest_of(as_bytes(manifest())); }

std::string FakeMap::catalog_document() const {
  return json{{"maps", {{{"name", "town"}, {"build", build()}}}}}.dump();
}

std::string FakeMap::current_document() const {
  json document = json::parse(map_document());
  document["name"] = "town";
  document["build"] = build();
  return document.dump();
}

std::string FakeMap::manifest() const {
  return manifest_document({ListedDocument::of(map_document()),
                            ListedDocument::of(areas_document()),
                            {{"s1", ListedDocument::of(segment_document())}}});
}

std::string FakeMap::map_document() const {
  return *milepost::map_document({.layers = {{"tracklets", kTracklets}, {"walls", kWalls}},
                                  .feature_json = to_json(FeatureParameters()).dump(),
                                  .bounds = {8.4, 49, 8.4, 49.0018},
                                  .segments = 1,
                                  .length_m = 200});
}

std::string FakeMap::segment_document() const {
  const StoredSegment segment{
      "s1",
      200,
      {{49.0, 8.4, 110, 0}, {49.0009, 8.4, 110, 100}, {49.0018, 8.4, 111, 200}},
      {{"s2"}, {"s9", "village"}},
      {{"morning", 40, 240}},
      {0.15, 100, true}};
  return milepost::segment_document(segment, {{"tracklets", index}});
}

std::string FakeMap::areas_document() const { return milepost::areas_document({{"walls", cells}}); }

std::string FakeMap::near_document() const {
  const json entry = {{"map", "town"},   {"build", build()},   {"segment", "s1"},
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
  const std::string root = "/v1/maps/town/builds/" + build();
  const std::string segment = root + "/segments/s1";
  const std::string areas = root + "/areas";
  const bool is_old = target.starts_with("/v1/maps/town/builds/") && !target.starts_with(root);
  if (is_old) return problem(410, "the build was replaced");
  const auto ok = [](std::string body) { return ScriptedAnswer{.body = std::move(body)}; };
  if (target == "/v1/maps") return ok(catalog_document());
  if (target == "/v1/maps/town") return ok(current_document());
  if (target == root + "/manifest") return ok(manifest());
  if (target == root + "/manifest.sig" && !signature.empty()) return ok(signature);
  if (target == root + "/map") return ok(map_document());
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
