// Complete maps of a simulated street, as built by milepost-mapper.
#include "mapper/pipeline/build_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <sstream>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "schema/feature/pca_projection.h"
#include "schema/store/map_store.h"
#include "schema/tile/codec.h"
#include "tests/simulator/record.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::Key;
using testing::TempFolder;
using ::testing::UnorderedElementsAre;

// Recorded once: 60 m of the street through a small camera.
const Drive& street() {
  static const TempFolder folder;
  static const Drive drive = [] {
    const simulator::Town town = simulator::make_town(3);
    const simulator::Lighting lighting = simulator::light_town(town, simulator::noon_light());
    for (simulator::RunPlan run : simulator::make_runs(town.network, town.seed, 60)) {
      if (run.name != "street-map") continue;
      run.camera = {300, 250, 178.75, 200.05, 150, 125};
      EXPECT_TRUE(simulator::record(town, lighting, run, folder.path(), 2).ok());
    }
    return read_drive(folder.path()).value();
  }();
  return drive;
}

// A map in a folder of its own.
class BuiltMap {
 public:
  explicit BuiltMap(const BuildSettings& settings = {}, int jobs = 2) {
    const auto built =
        build_map({street()}, file(), settings, jobs, [](const BuildProgress&) { return true; });
    EXPECT_TRUE(built.ok());
    if (built) report = *built;
  }
  std::filesystem::path file() const { return folder_ / "street.map"; }
  MapReader reader() const { return MapReader::open(file()).value(); }
  std::string bytes() const {
    std::ostringstream content;
    content << std::ifstream(file(), std::ios::binary).rdbuf();
    return content.str();
  }

  BuildReport report;

 private:
  TempFolder folder_;
};

BuildSettings laboratory() {
  BuildSettings settings;
  settings.lab = true;
  return settings;
}

TEST(BuildMap, TheDefaultMapHoldsLandmarksAndTheirCodebook) {
  const BuiltMap map;
  const MapReader reader = map.reader();
  ASSERT_THAT(reader.layers(), ElementsAre(Key("tracklets")));
  const json parameters = json::parse(reader.layers().at("tracklets"));
  EXPECT_EQ(parameters.at("items"), "landmarks");
  EXPECT_EQ(parameters.at("tile_length_m"), 20);
  EXPECT_EQ(parameters.at("focal_px"), json({1000.0, 1000.0}));
  const Result<PcaProjection> projection = PcaProjection::from_json(parameters.at("codebook"));
  ASSERT_TRUE(projection.ok()) << projection.error().line();
  EXPECT_EQ(projection->quantization_step(), BuildSettings{}.quantization_step);
  EXPECT_FALSE(parameters.contains("model"));
}

TEST(BuildMap, TheIndexHoldsEveryLandmarkAndTheReportCountsThem) {
  const BuiltMap map;
  const MapReader reader = map.reader();
  ASSERT_THAT(reader.segment_ids(), ElementsAre("street-map-0"));
  std::size_t landmarks = 0;
  std::uint64_t bytes = 0;
  const auto index = reader.tile_index("street-map-0", "tracklets").value();
  ASSERT_GE(index.size(), 2U);
  for (const TileEntry& entry : index) {
    const Bytes frame = reader.tile("street-map-0", "tracklets", entry.index).value();
    const Result<LandmarkTile> tile = decode_landmarks(frame);
    ASSERT_TRUE(tile.ok()) << tile.error().line();
    EXPECT_EQ(tile->landmarks.size(), entry.items);
    for (const Landmark& landmark : tile->landmarks) {
      EXPECT_LE(entry.along.from_m, landmark.along.from_m);
      EXPECT_GE(entry.along.to_m, landmark.along.to_m);
    }
    landmarks += tile->landmarks.size();
    bytes += frame.size();
  }
  EXPECT_GT(landmarks, 50U);
  EXPECT_EQ(map.report.maps.front().tracklets, landmarks);
  EXPECT_EQ(map.report.maps.front().tracklet_bytes, bytes);
  EXPECT_EQ(map.report.maps.front().tiles, index.size());
}

TEST(BuildMap, NoTileOfLandmarksWeighsMoreThanTheTarget) {
  BuildSettings settings;
  settings.landmarks.size_target_kb_per_m = 0.1;
  const BuiltMap map(settings);
  const MapReader reader = map.reader();
  const double length_m = reader.segment("street-map-0")->length_m;
  const auto index = reader.tile_index("street-map-0", "tracklets").value();
  ASSERT_GE(index.size(), 2U);
  for (const TileEntry& entry : index) {
    EXPECT_LE(static_cast<double>(entry.bytes),
              100 * std::min(20.0, length_m - 20.0 * entry.index));
  }
  EXPECT_LT(map.report.maps.front().tracklet_bytes, BuiltMap().report.maps.front().tracklet_bytes);
}

TEST(BuildMap, TheSameBytesForAnyNumberOfJobs) {
  const std::string with_one = BuiltMap(laboratory(), 1).bytes();
  EXPECT_TRUE(with_one == BuiltMap(laboratory(), 4).bytes());
}

// The street's drive again under another name, with all positions moved to the north.
Drive moved_street(double north_m) {
  Drive moved = street();
  moved.name = "moved";
  for (Frame& frame : moved.frames)
    frame.position = LocalFrame(frame.position).geo_from_enu({0, north_m, 0});
  return moved;
}

struct FusedMap {
  BuildReport report;
  std::vector<LandmarkTile> tiles;
  StoredSegment segment;
};

FusedMap fused_map(const std::vector<Drive>& drives, int jobs, PassPolicy passes) {
  const TempFolder folder;
  BuildSettings settings;
  settings.passes = passes;
  const auto built =
      build_map(drives, folder / "fused.map", settings, jobs, [](const auto&) { return true; });
  EXPECT_TRUE(built.ok());
  const MapReader reader = MapReader::open(folder / "fused.map").value();
  const std::string id = reader.segment_ids().front();
  FusedMap map{*built, {}, reader.segment(id).value()};
  const auto index = reader.tile_index(id, "tracklets").value();
  for (const TileEntry& entry : index)
    map.tiles.push_back(
        decode_landmarks(reader.tile(id, "tracklets", entry.index).value()).value());
  return map;
}

// Where landmarks of equal descriptors are in the second map, seen from the first: the median.
double moved_north_m(const FusedMap& from, const FusedMap& to) {
  std::vector<double> north_m;
  for (const LandmarkTile& a : from.tiles) {
    for (const LandmarkTile& b : to.tiles) {
      if (a.index != b.index) continue;
      const auto origin = [&](const FusedMap& map) {
        std::vector<GeoPoint> line;
        for (const StoredVertex& vertex : map.segment.vertices)
          line.push_back({vertex.latitude_deg, vertex.longitude_deg, vertex.altitude_m});
        return LocalFrame(RouteLine::from_vertices(line)->point_at(a.origin_m));
      };
      const LocalFrame in_a = origin(from);
      const LocalFrame in_b = origin(to);
      for (const Landmark& landmark : a.landmarks) {
        const auto same =
            std::ranges::find(b.landmarks, landmark.descriptor, &Landmark::descriptor);
        if (same == b.landmarks.end()) continue;
        north_m.push_back(in_a.enu_from_geo(in_b.geo_from_enu(same->position)).north_m -
                          landmark.position.north_m);
      }
    }
  }
  EXPECT_GT(north_m.size(), 50U);
  std::ranges::sort(north_m);
  return north_m[north_m.size() / 2];
}

TEST(BuildMap, FusedDrivesMeetHalfWay) {
  const std::vector<Drive> drives = {street(), moved_street(0.3)};
  const FusedMap single = fused_map({street()}, 2, PassPolicy::keep_best);
  const FusedMap fused = fused_map(drives, 2, PassPolicy::fuse);
  EXPECT_NEAR(moved_north_m(single, fused), 0.15, 0.03);
  const MapReport& report = fused.report.maps.front();
  EXPECT_GT(report.repeated, report.tracklets / 2);
  EXPECT_EQ(single.report.maps.front().repeated, 0U);
  EXPECT_LE(static_cast<double>(report.tracklet_bytes),
            1.05 * static_cast<double>(single.report.maps.front().tracklet_bytes));
  EXPECT_EQ(fused.segment.passes.size(), 2U);
}

TEST(BuildMap, ADriveThatIsGivenTwiceTellsNothingNew) {
  Drive again = street();
  again.name = "again";
  const FusedMap once = fused_map({street()}, 2, PassPolicy::fuse);
  const FusedMap twice = fused_map({street(), again}, 2, PassPolicy::fuse);
  EXPECT_EQ(twice.report.findings.size(), 1U);
  EXPECT_EQ(twice.segment.passes.size(), 1U);
  EXPECT_EQ(twice.segment.position_error, once.segment.position_error);
  EXPECT_EQ(twice.segment.position_error, (PositionError{0.18, 200, true}));
}

TEST(BuildMap, WhatDrivesStateAndHowTheyDifferIsKept) {
  Drive stating = street();
  stating.position_error = {0.04, 80, ""};
  EXPECT_EQ(fused_map({stating}, 2, PassPolicy::fuse).segment.position_error,
            (PositionError{0.04, 80, false}));
  const PositionError found =
      fused_map({street(), moved_street(0.3)}, 2, PassPolicy::fuse).segment.position_error;
  EXPECT_FALSE(found.is_assumed);
  EXPECT_GT(*found.sigma_m, 0.05);
  EXPECT_LT(*found.sigma_m, 0.16);
}

TEST(BuildMap, FusedTheOrderOfDrivesAndTheNumberOfJobsPlayNoPart) {
  const FusedMap one = fused_map({street(), moved_street(0.3)}, 1, PassPolicy::fuse);
  const FusedMap other = fused_map({moved_street(0.3), street()}, 3, PassPolicy::fuse);
  EXPECT_EQ(one.report.maps.front().build, other.report.maps.front().build);
}

TEST(BuildMap, OfOneDriveFusingChangesNothing) {
  EXPECT_EQ(fused_map({street()}, 2, PassPolicy::fuse).report.maps.front().build,
            fused_map({street()}, 2, PassPolicy::keep_best).report.maps.front().build);
}

TEST(BuildMap, TheLaboratorysMapHoldsTheOtherMethodsLayersToo) {
  const BuiltMap map(laboratory());
  const MapReader reader = map.reader();
  const auto items_of = [&](const std::string& layer) {
    return json::parse(reader.layers().at(layer)).at("items").get<std::string>();
  };
  ASSERT_THAT(
      reader.layers(),
      UnorderedElementsAre(Key("frames"), Key("observations"), Key("tracklets"),
                           Key("tracklets-inverse-scale"), Key("tracklets-scale"), Key("wisurf")));
  EXPECT_EQ(items_of("tracklets"), "landmarks");
  EXPECT_EQ(items_of("tracklets-inverse-scale"), "tracklets");
  EXPECT_EQ(json::parse(reader.layers().at("tracklets-inverse-scale")).at("model"),
            "inverse-scale");
  EXPECT_EQ(json::parse(reader.layers().at("tracklets-scale")).at("model"), "scale");
  for (const auto& [layer, parameters] : reader.layers()) {
    EXPECT_FALSE(reader.tile_index("street-map-0", layer)->empty()) << layer;
  }
  // The default layer is that of the default map.
  const BuiltMap plain_map;
  const MapReader plain = plain_map.reader();
  const auto index = plain.tile_index("street-map-0", "tracklets").value();
  for (const TileEntry& entry : index) {
    EXPECT_EQ(reader.tile("street-map-0", "tracklets", entry.index).value(),
              plain.tile("street-map-0", "tracklets", entry.index).value());
  }
}

// The street with each frame's grey values as `change` makes them, in PNGs of up to 16 bits.
class ChangedStreet {
 public:
  explicit ChangedStreet(const std::function<void(cv::Mat& gray)>& change) {
    Drive drive = street();
    std::filesystem::create_directories(folder_ / drive.images);
    for (Frame& frame : drive.frames) {
      cv::Mat gray = cv::imread(drive.frame_path(frame).string(), cv::IMREAD_GRAYSCALE);
      change(gray);
      frame.filename = std::filesystem::path(frame.filename).stem().string() + ".png";
      EXPECT_TRUE(cv::imwrite((folder_ / drive.images / frame.filename).string(), gray));
    }
    EXPECT_TRUE(write_drive(drive, folder_.path()).ok());
  }

  Drive drive() const { return read_drive(folder_.path()).value(); }

 private:
  TempFolder folder_;
};

Result<BuildReport> built(const std::vector<Drive>& drives, const std::filesystem::path& map_file,
                          const BuildSettings& settings = {}) {
  return build_map(drives, map_file, settings, 2, [](const BuildProgress&) { return true; });
}

TEST(BuildMap, AFewBitsIn16AreMappedAsAll8) {
  const ChangedStreet eight([](cv::Mat&) {});
  const TempFolder folder;
  const std::size_t expected = built({eight.drive()}, folder / "8.map")->maps.front().tracklets;
  for (const int bits : {8, 10, 12, 14, 16}) {
    const ChangedStreet street_of_bits(
        [bits](cv::Mat& gray) { gray.convertTo(gray, CV_16U, ((1 << bits) - 1) / 255.0); });
    const auto report = built({street_of_bits.drive()}, folder / "bits.map");
    ASSERT_TRUE(report.ok()) << report.error().line();
    EXPECT_NEAR(static_cast<double>(report->maps.front().tracklets), static_cast<double>(expected),
                0.02 * static_cast<double>(expected))
        << bits << " bits";
  }
}

// The border lies across the street at its middle; the street leads to the right of it.
Division across_the_street(const std::filesystem::path& beyond) {
  const GeoPoint& begin = street().frames.front().position;
  const GeoPoint& end = street().frames.back().position;
  const LocalFrame frame(begin);
  const EnuPoint whole = frame.enu_from_geo(end);
  const auto at = [&](double left) {
    return frame.geo_from_enu(
        {whole.east_m / 2 - left * whole.north_m, whole.north_m / 2 + left * whole.east_m, 0});
  };
  return {Border::through(at(-1), at(1)).value(), beyond};
}

TEST(BuildMap, ABorderDividesTheMapAndItsSegmentsGoOnInTheOther) {
  const TempFolder folder;
  BuildSettings settings;
  settings.division = across_the_street(folder / "east.map");
  const auto report = built({street()}, folder / "west.map", settings);
  ASSERT_TRUE(report.ok()) << report.error().line();
  ASSERT_EQ(report->maps.size(), 2U);
  const MapReader west = MapReader::open(folder / "west.map").value();
  const MapReader east = MapReader::open(folder / "east.map").value();
  ASSERT_THAT(west.segment_ids(), ElementsAre("street-map-0"));
  ASSERT_EQ(east.segment_ids().size(), 1U);
  const std::string beyond = east.segment_ids().front();
  EXPECT_THAT(west.segment("street-map-0")->successors, ElementsAre(Successor{beyond, "east"}));
  EXPECT_TRUE(east.segment(beyond)->successors.empty());
  EXPECT_EQ(west.layers(), east.layers());
  EXPECT_TRUE(west.verify().ok() && east.verify().ok());
  for (const MapReport& map : report->maps) EXPECT_GT(map.tracklets, 50U) << map.file;

  // Seen from both, nothing is lost at the border.
  const BuiltMap whole;
  std::size_t tracklets = 0;
  for (const MapReport& map : report->maps) tracklets += map.tracklets;
  EXPECT_GT(tracklets, whole.report.maps.front().tracklets * 9 / 10);
}

TEST(BuildMap, ABorderThatLeavesAMapNoRoadIsRefused) {
  const TempFolder folder;
  BuildSettings settings;
  settings.division =
      Division{Border::through({80, 0, 0}, {80, 1, 0}).value(),  // all roads are south of it: right
               folder / "south.map"};
  const auto refused = built({street()}, folder / "north.map", settings);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().line(),
              ::testing::HasSubstr("north.map: all roads lie on the other side of the border"));
  EXPECT_FALSE(std::filesystem::exists(folder / "south.map"));
  settings.division = across_the_street(folder / "other" / "north.map");
  std::filesystem::create_directories(folder / "other");
  const auto alike = built({street()}, folder / "north.map", settings);
  ASSERT_FALSE(alike.ok());
  EXPECT_THAT(alike.error().line(), ::testing::HasSubstr("both maps would have the name 'north'"));
}

TEST(BuildMap, NothingFoundIsAnErrorAndTheOldMapStays) {
  const BuiltMap old;
  const std::string before = old.bytes();
  const ChangedStreet black([](cv::Mat& gray) { gray = 3; });
  const auto report = built({black.drive()}, old.file());
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.error().code, ErrorCode::invalid_input);
  const std::string frames = std::to_string(old.report.frames);
  EXPECT_EQ(
      report.error().line(),
      black.drive().folder.string() + ": nothing to localize with was found in its " + frames +
          " frames: features 0, grey values 3 to 3 of 0 to 255, tracklets 0; check its frames "
          "and their order, leave the drive out, or give --allow-empty");
  EXPECT_TRUE(old.bytes() == before);
}

TEST(BuildMap, ADriveThatGivesNothingIsNamedAmongOthers) {
  const ChangedStreet black([](cv::Mat& gray) { gray = 0; });
  Drive dark = black.drive();
  dark.name = "dark";
  for (Frame& frame : dark.frames) frame.position.longitude_deg += 0.01;  // on another road
  const TempFolder folder;
  const auto refused = built({street(), dark}, folder / "two.map");
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().where, dark.folder.string());
  EXPECT_FALSE(std::filesystem::exists(folder / "two.map"));

  BuildSettings settings;
  settings.allow_empty = true;
  const auto allowed = built({street(), dark}, folder / "two.map", settings);
  ASSERT_TRUE(allowed.ok()) << allowed.error().line();
  ASSERT_EQ(allowed->drives.size(), 2U);
  EXPECT_EQ(allowed->drives[1].tracklets, allowed->maps.front().tracklets);
  EXPECT_GT(allowed->drives[1].features, 1000U);
  EXPECT_EQ(allowed->drives[0].tracklets, 0U);
  EXPECT_EQ(allowed->drives[0].brightest, 0);
  EXPECT_TRUE(MapReader::open(folder / "two.map")->verify().ok());
}

}  // namespace
}  // namespace milepost
