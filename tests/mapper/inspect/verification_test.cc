// Maps whose bytes are those of their build, but whose content contradicts itself.
#include "mapper/inspect/verification.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "schema/geo/geodesy.h"
#include "schema/tile/codec.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr const char* kLandmarkLayer = R"({"items": "landmarks"})";

// A segment of 100 m northwards that begins so far east of the origin.
StoredSegment segment(const std::string& id, double east_m,
                      std::vector<Successor> successors = {}) {
  const LocalFrame local({49, 8.4, 110});
  StoredSegment made{id, 0, {}, std::move(successors)};
  for (const double north_m : {0.0, 50.0, 100.0}) {
    const GeoPoint at = local.geo_from_enu({east_m, north_m, 0});
    if (!made.vertices.empty()) {
      const StoredVertex& before = made.vertices.back();
      made.length_m +=
          geodesic_distance_m({before.latitude_deg, before.longitude_deg, before.altitude_m}, at);
    }
    made.vertices.push_back({at.latitude_deg, at.longitude_deg, at.altitude_m, made.length_m});
  }
  return made;
}

Bytes tile_of(const std::string& id, std::uint32_t index, const AlongRange& along) {
  Landmark landmark;
  landmark.position = {3, 4, 1};
  landmark.depth_sigma_m = 0.5;
  landmark.size_m = 0.2F;
  landmark.along = along;
  landmark.observations = 5;
  return encode_landmarks({id, index, 0, {landmark}});
}

std::vector<Finding> found_in(const std::function<void(MapWriter&)>& fill) {
  const testing::TempFolder folder;
  Result<MapWriter> writer = MapWriter::create(folder / "town.map");
  EXPECT_TRUE(writer.ok());
  EXPECT_TRUE(writer->add_layer("tracklets", kLandmarkLayer).ok());
  fill(*writer);
  const Result<std::string> build = writer->finish();
  EXPECT_TRUE(build.ok()) << build.error().line();
  const Result<MapReader> map = MapReader::open(folder / "town.map");
  EXPECT_TRUE(map.ok()) << map.error().line();
  return contradictions_in(*map);
}

MATCHER_P2(Is, kind, what, "") {
  return arg.kind == kind && (arg.where + ": " + arg.what).find(what) != std::string::npos;
}

TEST(Verification, ASoundMapHasNone) {
  EXPECT_THAT(
      found_in([](MapWriter& map) {
        EXPECT_TRUE(map.add_segment(segment("a", 0, {{"x", "neighbour"}})).ok());
        EXPECT_TRUE(map.add_tile("a", "tracklets", 0, {5, 25}, 1, tile_of("a", 0, {5, 25})).ok());
      }),
      IsEmpty());
}

TEST(Verification, LinksThatLeadNowhere) {
  EXPECT_THAT(found_in([](MapWriter& map) {
                EXPECT_TRUE(map.add_segment(segment("a", 0, {{"b"}, {"gone"}})).ok());
                EXPECT_TRUE(map.add_segment(segment("b", 500)).ok());
              }),
              ElementsAre(Is("link", "segment a: goes on to 'b', which begins"),
                          Is("link", "goes on to 'gone', which is not in the map")));
}

TEST(Verification, LinesWhoseLengthsAreOthers) {
  EXPECT_THAT(found_in([](MapWriter& map) {
                StoredSegment bent = segment("a", 0);
                bent.vertices[1].along_m += 5;
                EXPECT_TRUE(map.add_segment(bent).ok());
              }),
              ElementsAre(Is("line", "segment a, vertex 1: lies 50.0")));
}

TEST(Verification, TilesThatAreOthers) {
  EXPECT_THAT(found_in([](MapWriter& map) {
                EXPECT_TRUE(map.add_segment(segment("a", 0)).ok());
                const auto add = [&](std::uint32_t index, std::uint64_t items, const Bytes& bytes) {
                  EXPECT_TRUE(map.add_tile("a", "tracklets", index, {5, 25}, items, bytes).ok());
                };
                add(0, 1, Bytes{1, 2, 3});
                add(1, 1, tile_of("b", 1, {5, 25}));
                add(2, 2, tile_of("a", 2, {5, 25}));
                add(3, 1, tile_of("a", 3, {5, 26}));
              }),
              ElementsAre(Is("tile", "tile 0: "), Is("tile", "tile 1: is tile 1 of segment 'b'"),
                          Is("tile", "tile 2: holds 1 items, not 2"),
                          Is("tile", "tile 3: holds a landmark beyond its range")));
}

TEST(Verification, ARecordOfTheMappingThatCannotBeRead) {
  const auto with = [](const std::string& record) {
    return found_in([&](MapWriter& map) {
      EXPECT_TRUE(map.add_segment(segment("a", 0, {{"x", "neighbour"}})).ok());
      EXPECT_TRUE(map.set_mapping_document(record).ok());
    });
  };
  EXPECT_THAT(with(R"({"drives":[],"findings":[],"segments":[]})"), IsEmpty());
  EXPECT_THAT(with(R"({"drives":7})"),
              ElementsAre(Is("malformed_record", "the record of its mapping")));
}

}  // namespace
}  // namespace milepost
