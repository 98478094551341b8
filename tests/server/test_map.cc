#include "tests/server/test_map.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <stdexcept>

#include "schema/geo/route_line.h"
#include "schema/tile/codec.h"

namespace milepost::server {
namespace {

void must(const Status& status) {
  if (!status) throw std::runtime_error(status.error().line());
}

// Four vertices, 66.7 m apart, from 49 N 8 E.
StoredSegment segment(const std::string& id, double north_deg, double east_deg,
                      std::vector<Successor> successors) {
  std::vector<GeoPoint> points;
  points.reserve(4);
  for (int i = 0; i < 4; ++i) points.push_back({49 + i * north_deg, 8 + i * east_deg, 110.25});
  const Result<RouteLine> line = RouteLine::from_vertices(points);
  StoredSegment stored{id, line->length_m(), {}, std::move(successors)};
  for (std::size_t i = 0; i < points.size(); ++i) {
    stored.vertices.push_back(
        {points[i].latitude_deg, points[i].longitude_deg, 110.25, line->along_m()[i]});
  }
  return stored;
}

Bytes arbitrary_bytes(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  Bytes bytes(count);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

std::string finished(MapWriter& writer) {
  const Result<std::string> build = writer.finish();
  if (!build) throw std::runtime_error(build.error().line());
  return *build;
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "milepost-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

namespace {

void begin_town(MapWriter& writer, bool has_s2) {
  must(writer.set_feature_json(R"({"extractor": "sift", "contrast": 0.04})"));
  must(writer.add_layer("tracklets", R"({"tile_m": 50})"));
  must(writer.add_layer("walls", "{}"));
  std::vector<Successor> successors = {{"far", "village"}};
  if (has_s2) successors.insert(successors.begin(), {"s2"});
  must(writer.add_segment(segment("s1", 0.0006, 0, std::move(successors))));
  if (has_s2) must(writer.add_segment(segment("s2", 0, 0.0009, {})));
}

const std::vector<AlongRange> kTownRanges = {{0, 60}, {50, 110}, {100, 160}, {150, 200}};

}  // namespace

TownMap write_town(const std::filesystem::path& file, std::size_t frame_bytes, unsigned seed) {
  Result<MapWriter> writer = MapWriter::create(file);
  if (!writer) throw std::runtime_error(writer.error().line());
  begin_town(*writer, true);
  TownMap town;
  for (std::uint32_t i = 0; i < kTownRanges.size(); ++i) {
    town.frames.push_back(arbitrary_bytes(frame_bytes + i, seed * 100 + i));
    must(writer->add_tile("s1", "tracklets", i, kTownRanges[i], 10 + i, town.frames.back()));
  }
  for (const std::uint32_t cell : kTownCells) {
    const auto i = static_cast<unsigned>(town.cells.size());
    town.cells.push_back(arbitrary_bytes(frame_bytes + i, seed * 100 + 50 + i));
    must(writer->add_cell("walls", cell, 20 + i, town.cells.back()));
  }
  town.build = finished(*writer);
  return town;
}

std::string write_changed_town(const std::filesystem::path& file, const TownMap& town) {
  Result<MapWriter> writer = MapWriter::create(file);
  if (!writer) throw std::runtime_error(writer.error().line());
  begin_town(*writer, false);
  for (std::uint32_t i = 0; i < 3; ++i) {
    const Bytes frame = i == 1 ? arbitrary_bytes(77, 7) : town.frames[i];
    must(writer->add_tile("s1", "tracklets", i, kTownRanges[i], 10 + i, frame));
  }
  for (unsigned i = 0; i < 3; ++i)
    must(writer->add_cell("walls", kTownCells[i], 20 + i, town.cells[i]));
  return finished(*writer);
}

LaneMap write_lane(const std::filesystem::path& file, std::size_t landmarks) {
  Result<MapWriter> writer = MapWriter::create(file);
  if (!writer) throw std::runtime_error(writer.error().line());
  LaneMap lane{"", {"s1", 0, 0, {}}, tiles_of({{{49.001, 8.001}, {49.001, 8.002}}}).front(), {}};
  for (std::size_t i = 0; i < landmarks; ++i) {
    Landmark landmark;
    landmark.position = {0, static_cast<double>(i % 300), 2};
    landmark.depth_sigma_m = 0.5F;
    landmark.size_m = 1;
    landmark.observations = 5;
    landmark.passes = 2;
    lane.landmarks.landmarks.push_back(landmark);
  }
  PoseFit fit{10, 100, 95, 0.5, 0.02, 0.01, 0.1};
  lane.mapping = {{{"monday", fit}}, {{"s1", {{0, 10, "monday", fit}}}}, {}, {}};
  must(writer->add_layer("tracklets", R"({"items": "landmarks", "tile_length_m": 50})"));
  must(writer->add_layer("walls", R"({"items": "walls"})"));
  must(writer->add_segment(segment("s1", 0.0006, 0, {})));
  must(
      writer->add_tile("s1", "tracklets", 0, {0, 60}, landmarks, encode_landmarks(lane.landmarks)));
  must(writer->add_cell("walls", lane.walls.cell, 1, encode_walls(lane.walls)));
  must(writer->set_mapping_document(mapping_document(lane.mapping)));
  lane.build = finished(*writer);
  return lane;
}

std::string write_walls(const std::filesystem::path& file,
                        const std::vector<std::uint32_t>& cells) {
  Result<MapWriter> writer = MapWriter::create(file);
  if (!writer) throw std::runtime_error(writer.error().line());
  must(writer->add_layer("walls", R"({"items": "walls"})"));
  for (const std::uint32_t cell : cells) {
    must(writer->add_cell("walls", cell, 1, arbitrary_bytes(4, cell)));
  }
  return finished(*writer);
}

std::shared_ptr<const ServedMap> served_map(const Catalog& catalog, const std::string& name) {
  const auto map = catalog.read(*catalog.maps().at(name));
  if (!map) throw std::runtime_error(map.error().line());
  return *map;
}

std::shared_ptr<const Catalog> open_catalog(const std::filesystem::path& folder, unsigned readers) {
  CatalogSettings settings;
  settings.open_maps.readers = readers;
  const auto catalog = Catalog::open(folder, settings, [](const std::string&) {});
  if (!catalog) throw std::runtime_error(catalog.error().line());
  return *catalog;
}

}  // namespace milepost::server
