// The program milepost-simulator, run as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

#include "schema/base/file.h"
#include "schema/drive/drive.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using ::testing::HasSubstr;

struct Outcome {
  int exit_code = -1;
  std::string output;  // both streams
};

Outcome run_simulator(const std::string& arguments) {
  const std::string command = std::string(MILEPOST_SIMULATOR) + " " + arguments + " 2>&1";
  Outcome outcome;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  std::array<char, 4096> buffer;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    outcome.output.append(buffer.data(), count);
  }
  outcome.exit_code = WEXITSTATUS(::pclose(pipe));
  return outcome;
}

TEST(SimulatorCommand, WritesADriveOfEachNameAndSaysNothingInAPipe) {
  const testing::TempFolder folder;
  const Outcome outcome =
      run_simulator("--out " + folder.path().string() +
                    " --route street --length-m 10 --seed 7 --camera-px 120 100");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.output, "");
  for (const char* name : {"street-map", "street-query", "street-query-back"}) {
    const Result<Drive> drive = read_drive(folder / name);
    ASSERT_TRUE(drive.ok()) << drive.error().line();
    EXPECT_EQ(drive->camera.width_px, 120);
    EXPECT_NEAR(drive->camera.pinhole.focal_x_px, 71.5, 0.1);
    EXPECT_NEAR(drive->camera.pinhole.focal_y_px, 80.0, 0.1);
  }
}

TEST(SimulatorCommand, MapsAtTheSpacingThatIsAskedFor) {
  const testing::TempFolder folder;
  const std::string drives = folder.path().string();
  ASSERT_EQ(run_simulator("--out " + drives +
                          " --drive street-map --length-m 10 --map-spacing-m 0.5 --camera-px 60 50")
                .exit_code,
            0);
  const Result<Drive> drive = read_drive(folder / "street-map");
  ASSERT_TRUE(drive.ok()) << drive.error().line();
  EXPECT_EQ(drive->frames.size(), 20U);
  EXPECT_NEAR(geodesic_distance_m(drive->frames[3].position, drive->frames[4].position), 0.5, 0.01);
}

TEST(SimulatorCommand, ListsEveryRouteWithItsMapAndQuery) {
  const Outcome outcome = run_simulator("--list");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* name : {"town-main-map", "town-main-query", "town-main-query-lane",
                           "town-main-query-traffic", "town-hill-map", "town-loop-map"}) {
    EXPECT_THAT(outcome.output, HasSubstr(name));
  }
}

TEST(SimulatorCommand, Teaches) {
  const Outcome outcome = run_simulator("--help");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* option : {"--out",
                             "--route",
                             "--drive",
                             "--list",
                             "--length-m",
                             "--seed",
                             "--ortho",
                             "--walls",
                             "--position-noise-m",
                             "--position-drift-m",
                             "--position-bias-m",
                             "--heading-noise-deg",
                             "--city",
                             "--small",
                             "--fleet",
                             "city-1-tour",
                             "city-graph.json",
                             "--map-spacing-m",
                             "--camera-px",
                             "--view-deg",
                             "NAME-map"}) {
    EXPECT_THAT(outcome.output, HasSubstr(option));
  }
  EXPECT_THAT(outcome.output, HasSubstr("(10 to 10000, default 10000)"));
}

TEST(SimulatorCommand, RefusesAWrongCall) {
  EXPECT_EQ(run_simulator("").exit_code, 2);
  EXPECT_EQ(run_simulator("--out /nowhere --length-m 0").exit_code, 2);
  EXPECT_EQ(run_simulator("--out /nowhere --no-such-option").exit_code, 2);
  const Outcome outcome = run_simulator("--out /nowhere --route nowhere");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.output, HasSubstr("there is no route 'nowhere'"));
}

TEST(SimulatorCommand, ListsTheDrivesAndToursOfACity) {
  const Outcome small = run_simulator("--city --small --list");
  EXPECT_EQ(small.exit_code, 0);
  for (const char* name : {"city-1-map", "city-2-map", "city-1-tour"}) {
    EXPECT_THAT(small.output, HasSubstr(name));
  }
  EXPECT_THAT(small.output, ::testing::Not(HasSubstr("city-3-map")));
  const Outcome full = run_simulator("--city --list");
  EXPECT_EQ(full.exit_code, 0);
  EXPECT_THAT(full.output, HasSubstr("city-6-map"));
  EXPECT_THAT(full.output, ::testing::Not(HasSubstr("town-main-map")));
}

TEST(SimulatorCommand, WritesACityWithItsGraphAndStatesOtherPositionsWithoutRendering) {
  const testing::TempFolder folder;
  const std::string call = "--out " + folder.path().string() +
                           " --city --small --drive city-1-map --length-m 10 --camera-px 40 32";
  const Outcome first = run_simulator(call);
  EXPECT_EQ(first.exit_code, 0);
  EXPECT_EQ(first.output, "");
  EXPECT_TRUE(std::filesystem::exists(folder / "city-graph.json"));
  const std::filesystem::path frame = folder / "city-1-map" / "frames" / "000000.jpg";
  const std::filesystem::path trajectory = folder / "city-1-map" / "trajectory.csv";
  const auto exact = *read_text_file(trajectory);
  const auto rendered = std::filesystem::last_write_time(frame);
  for (const char* option :
       {"--position-noise-m", "--position-drift-m", "--position-bias-m", "--heading-noise-deg"}) {
    EXPECT_EQ(run_simulator(call + " " + option + " 0.3").exit_code, 0);
    EXPECT_NE(*read_text_file(trajectory), exact) << option;
    EXPECT_EQ(std::filesystem::last_write_time(frame), rendered);
  }
  EXPECT_EQ(run_simulator(call).exit_code, 0);
  EXPECT_EQ(*read_text_file(trajectory), exact);
}

TEST(SimulatorCommand, RefusesTownsDrivesInACityAndASmallTown) {
  const Outcome route = run_simulator("--out /nowhere --city --route town-main");
  EXPECT_EQ(route.exit_code, 2);
  EXPECT_THAT(route.output, HasSubstr("there is no route 'town-main'"));
  const Outcome drive = run_simulator("--out /nowhere --city --small --drive city-6-map");
  EXPECT_EQ(drive.exit_code, 2);
  EXPECT_THAT(drive.output, HasSubstr("there is no drive 'city-6-map'"));
  const Outcome small = run_simulator("--out /nowhere --small");
  EXPECT_EQ(small.exit_code, 2);
  EXPECT_THAT(small.output, ::testing::MatchesRegex("[^\n]*--small[^\n]*--city[^\n]*\n"));
  const Outcome fleet = run_simulator("--out /nowhere --fleet");
  EXPECT_EQ(fleet.exit_code, 2);
  EXPECT_THAT(fleet.output, ::testing::MatchesRegex("[^\n]*--fleet[^\n]*--city[^\n]*\n"));
  EXPECT_EQ(run_simulator("--out /nowhere --city --small --fleet").exit_code, 2);
}

TEST(SimulatorCommand, ReplacesNoFileOfAnotherKind) {
  const testing::TempFolder folder;
  const std::filesystem::path letter = folder / "letter.txt";
  ASSERT_TRUE(write_text_file(letter, "Dear reader").ok());
  for (const std::string option : {"--ortho", "--walls"}) {
    const Outcome outcome = run_simulator(option + " " + letter.string());
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.output, HasSubstr("letter.txt: the existing file is not a "));
    EXPECT_EQ(*read_text_file(letter), "Dear reader");
  }
}

TEST(SimulatorCommand, NamesWhatFailedInOneLine) {
  const Outcome outcome = run_simulator("--out /dev/null/x --drive street-map --length-m 10");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.output,
              ::testing::MatchesRegex("milepost-simulator: /dev/null/x/street-map/frames: cannot "
                                      "be created [^\n]*\n"));
}

}  // namespace
}  // namespace milepost
