// Whether passes show the same road, by frames of the simulator.
#include "mapper/pipeline/pass_comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "tests/mapper/noise_drive.h"
#include "tests/simulator/record.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

// Recorded once: the begin of a street twice, and of another road.
const Drive& recorded_drive(const std::string& name) {
  static const testing::TempFolder folder;
  static const std::map<std::string, Drive> drives = [] {
    std::map<std::string, Drive> made;
    const simulator::Town town = simulator::make_town(3);
    const simulator::Lighting lighting = simulator::light_town(town, simulator::noon_light());
    for (simulator::RunPlan run : simulator::make_runs(town.network, town.seed, 40)) {
      const bool is_wanted =
          run.name == "street-map" || run.name == "street-query" || run.name == "town-loop-map";
      if (!is_wanted) continue;
      run.camera = {420, 350, 250, 280, 210, 175};
      const std::filesystem::path drive = folder / run.name;
      EXPECT_TRUE(simulator::record(town, lighting, run, drive, 2).ok());
      made[run.name] = read_drive(drive).value();
    }
    return made;
  }();
  return drives.at(name);
}

// Laid onto the positions of another drive.
Drive laid_onto(Drive drive, const Drive& other, const std::string& name) {
  drive.name = name;
  drive.frames.resize(std::min(drive.frames.size(), other.frames.size()));
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    drive.frames[i].position = other.frames[i].position;
    drive.frames[i].heading_deg = other.frames[i].heading_deg;
  }
  return drive;
}

struct Compared {
  std::optional<bool> same;
  std::optional<Error> failure;
};

Compared compared(const Drive& a, const Drive& b) {
  const std::vector<const Drive*> drives = {&a, &b};
  std::vector<NamedDrivenLines> lines;
  std::vector<Pass> passes;
  for (const Drive* drive : drives) {
    lines.push_back(driven_lines(*drive, {}).value());
    passes.push_back({passes.size(), 0, 0, lines.back().lines.front().line.length_m()});
  }
  const BuildSettings settings;
  PassFrames frames(drives, lines, 2);
  PassComparison comparison(frames, settings);
  const std::optional<bool> same = comparison.show_the_same_road(passes[0], passes[1]);
  return {same, frames.failure()};
}

TEST(PassComparison, TwoDrivesOfOneStreetShowTheSame) {
  EXPECT_EQ(compared(recorded_drive("street-map"), recorded_drive("street-query")).same, true);
}

TEST(PassComparison, AnotherRoadInItsPlaceDoesNot) {
  const Drive above =
      laid_onto(recorded_drive("town-loop-map"), recorded_drive("street-map"), "above");
  EXPECT_EQ(compared(recorded_drive("street-map"), above).same, false);
}

TEST(PassComparison, DarkFramesDoNotTell) {
  const testing::TempFolder folder;
  const Drive street = recorded_drive("street-map");
  const Drive dark =
      laid_onto(testing::noise_drive(folder.path(), "dark", 40, 1, 3), street, "dark");
  EXPECT_FALSE(compared(street, dark).same.has_value());
  EXPECT_FALSE(compared(street, dark).failure.has_value());
}

TEST(PassComparison, AFrameThatCannotBeReadIsAnError) {
  Drive lost = recorded_drive("street-query");
  lost.folder = "/nowhere";
  EXPECT_TRUE(compared(recorded_drive("street-map"), lost).failure.has_value());
}

}  // namespace
}  // namespace milepost
