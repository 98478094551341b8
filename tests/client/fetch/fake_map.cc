#include "tests/client/fetch/fake_map.h"

#include <random>

#include <nlohmann/json.hpp>

#include "schema/base/digest.h"

namespace milepost::testing {
namespace {

using nlohmann::json;

constexpr std::uint32_t kTiles = 10;

std::string text_of(const Bytes& bytes) { return std::string(as_text(bytes)); }

}  // namespace

FakeMap::FakeMap() {
  for (std::uint32_t k = 0; k < kTiles; ++k) {
    const Bytes bytes = frame(k);
    index.push_back({k, {20.0 * k, 20.0 * k + 25}, 10, bytes.size(), digest_of(bytes)});
  }
}

Bytes FakeMap::frame(std::uint32_t index_of_tile) const {
  std::mt19937 random(index_of_tile + 1);
  Bytes bytes(1000 + 10 * index_of_tile);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

std::string FakeMap::map_document() const {
  return json{
      {"name", "town"},
      {"build", build},
      {"layers", {"tracklets", "walls"}},
      {"layer_parameters", {{"tracklets", {{"tile_length_m", 20}}}, {"walls", {{"a", 1}}}}},
      {"feature", {{"kind", "sift"}}},
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

std::string FakeMap::near_document() const {
  const json entry = {{"map", "town"},   {"build", build},     {"segment", "s1"},
                      {"along_m", 50.0}, {"distance_m", 1.25}, {"length_m", 200}};
  return json{{"segments", {entry}}}.dump();
}

std::string FakeMap::range_body(const AlongRange& range) const {
  std::string body;
  for (const TileEntry& entry : index) {
    if (entry.along.meets(range)) body += text_of(frame(entry.index));
  }
  return body;
}

ScriptedAnswer FakeMap::answer(const std::string& target) const {
  const std::string segment = "/v1/maps/town/builds/" + build + "/segments/s1";
  const auto ok = [](std::string body) { return ScriptedAnswer{.body = std::move(body)}; };
  if (target == "/v1/maps/town") return ok(map_document());
  if (target == segment) return ok(segment_document());
  if (target.starts_with("/v1/segments?")) return ok(near_document());
  if (const auto range = range_of(target)) return ok(range_body(*range));
  const std::string tile = segment + "/tiles/tracklets/";
  if (target.starts_with(tile)) {
    return ok(text_of(frame(static_cast<std::uint32_t>(std::stoul(target.substr(tile.size()))))));
  }
  return {.status = 404, .body = R"({"detail": "no such thing"})"};
}

std::optional<AlongRange> range_of(const std::string& target) {
  const auto number = [&](const std::string& key) {
    return std::stod(target.substr(target.find(key) + key.size()));
  };
  if (target.find("/tiles?layer=tracklets&from_m=") == std::string::npos) return std::nullopt;
  return AlongRange{number("from_m="), number("to_m=")};
}

bool is_tile_target(const std::string& target) {
  return target.find("/tiles") != std::string::npos;
}

}  // namespace milepost::testing
