#include "mapper/aerial/extraction.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <opencv2/imgproc.hpp>

#include "tests/mapper/aerial/drawn_yard.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;
using testing::drawn;
using testing::House;
using testing::is_found;
using testing::TempFolder;
using testing::walls_of;
using testing::Yard;

Yard settlement() {
  return {{90, 70},
          {{{20, 20}, 14, 9, 10},
           {{45, 20}, 12, 8, 100},
           {{72, 18}, 13, 9, 40},
           {{20, 50}, 12, 9, 0},
           {{48, 50}, 16, 9, 5},
           {{74, 50}, 12, 8, 60}},
          {300, 45},
          3,
          {{35, 35}, {60, 36}, {8, 36}}};
}

ExtractionSettings small_blocks() {
  ExtractionSettings settings;
  settings.block_m = 47;
  return settings;
}

bool go_on(const ExtractionProgress&) { return true; }

ExtractedWalls extract(const fs::path& file, const ExtractionSettings& settings, int jobs = 2) {
  Result<ExtractedWalls> walls = extract_walls({file, "", {}}, settings, jobs, "", go_on);
  EXPECT_TRUE(walls.ok()) << walls.error().line();
  return std::move(*walls);
}

// The yard's walls in the ground frame of the result.
WallLines true_walls(const Yard& yard, const GroundFrame& frame) {
  WallLines walls;
  for (const House& house : yard.houses) {
    for (const WallLine& wall : walls_of(house)) {
      walls.push_back({frame.ground_from_geo(testing::geo_from_yard(wall.begin_m)),
                       frame.ground_from_geo(testing::geo_from_yard(wall.end_m))});
    }
  }
  return walls;
}

std::ptrdiff_t found_of(const WallLines& walls, const WallLines& lines) {
  return std::count_if(walls.begin(), walls.end(),
                       [&](const WallLine& wall) { return is_found(wall, lines, 0.3); });
}

class Extraction : public ::testing::Test {
 protected:
  void SetUp() override { testing::write_geotiff(drawn(settlement()), file_); }

  TempFolder folder_;
  fs::path file_ = folder_ / "yard.tif";
};

TEST_F(Extraction, FindsTheWallsOfASettlement) {
  const ExtractedWalls found = extract(file_, {});
  const WallLines walls = true_walls(settlement(), found.frame);
  EXPECT_GE(found_of(walls, found.lines), 22);  // of 24
  EXPECT_LE(found.lines.size(), 27U);
  EXPECT_TRUE(found.sun_was_estimated);
  EXPECT_NEAR(found.sun.azimuth_deg, 300, 15);
}

TEST_F(Extraction, LinesOfTwoBlocksAreJoined) {
  const ExtractedWalls found = extract(file_, small_blocks());
  const WallLines walls = true_walls(settlement(), found.frame);
  EXPECT_GE(found_of(walls, found.lines), 20);
  EXPECT_LE(found.lines.size(), 30U);
}

TEST_F(Extraction, DoesNotDependOnThreads) {
  const WallLines once = extract(file_, small_blocks(), 1).lines;
  const WallLines again = extract(file_, small_blocks(), 3).lines;
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].begin_m, again[i].begin_m);
    EXPECT_EQ(once[i].end_m, again[i].end_m);
  }
}

TEST_F(Extraction, TheGivenSunIsTaken) {
  ExtractionSettings settings;
  settings.sun_azimuth_deg = 305;
  settings.sun_elevation_deg = 50;
  const ExtractedWalls found = extract(file_, settings);
  EXPECT_FALSE(found.sun_was_estimated);
  EXPECT_EQ(found.sun.azimuth_deg, 305);
  EXPECT_EQ(found.sun.elevation_deg, 50);
}

TEST_F(Extraction, EachStageCanBeLeftOut) {
  const WallLines with_all = extract(file_, {}).lines;
  for (const Stage stage : {Stage::shadows, Stage::vegetation, Stage::progressive, Stage::merging,
                            Stage::closure, Stage::corners, Stage::roofs}) {
    ExtractionSettings settings;
    settings.without = {stage};
    const WallLines others = extract(file_, settings).lines;
    EXPECT_GT(others.size(), 0U);
    const bool is_same = std::equal(with_all.begin(), with_all.end(), others.begin(), others.end(),
                                    [](const WallLine& a, const WallLine& b) {
                                      return a.begin_m == b.begin_m && a.end_m == b.end_m;
                                    });
    EXPECT_FALSE(is_same) << static_cast<int>(stage);
  }
  ExtractionSettings bare;
  bare.without = {Stage::shadows, Stage::vegetation, Stage::closure, Stage::roofs};
  EXPECT_GT(extract(file_, bare).lines.size(), with_all.size());
}

TEST_F(Extraction, GreyImagesHaveWallsToo) {
  Picture picture = drawn(settlement());
  cv::Mat grey;
  cv::cvtColor(picture.bgr, grey, cv::COLOR_BGR2GRAY);
  cv::cvtColor(grey, picture.bgr, cv::COLOR_GRAY2BGR);
  testing::write_geotiff(picture, folder_ / "grey.tif");
  const ExtractedWalls found = extract(folder_ / "grey.tif", {});
  EXPECT_GE(found_of(true_walls(settlement(), found.frame), found.lines), 16);
}

TEST_F(Extraction, DrawsEveryStage) {
  const fs::path pictures = folder_ / "pictures";
  fs::create_directory(pictures);
  ASSERT_TRUE(extract_walls({file_, "", {}}, {}, 1, pictures, go_on).ok());
  for (const char* const name : {"1-picture", "2-edges", "3-shadows", "4-clutter", "5-lines",
                                 "6-regions-1", "6-regions-4", "7-roofs", "8-roof-edges"}) {
    EXPECT_TRUE(fs::exists(pictures / ("block0-" + std::string(name) + ".png"))) << name;
  }
}

TEST_F(Extraction, StopsOnRequest) {
  const Result<ExtractedWalls> walls =
      extract_walls({file_, "", {}}, small_blocks(), 1, "",
                    [](const ExtractionProgress& at) { return at.blocks_done < 2; });
  ASSERT_FALSE(walls.ok());
  EXPECT_EQ(walls.error().code, ErrorCode::cancelled);
}

TEST_F(Extraction, AnEmptyYardHasNoWalls) {
  testing::write_geotiff(drawn({{40, 30}, {}, {}, 0, {}}), folder_ / "empty.tif");
  const ExtractedWalls found = extract(folder_ / "empty.tif", {});
  EXPECT_TRUE(found.lines.empty());
  EXPECT_FALSE(found.sun_was_estimated);
}

}  // namespace
}  // namespace milepost
