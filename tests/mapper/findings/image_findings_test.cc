// A simulated way round a corner, seen by a small camera.
#include "mapper/findings/image_findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "mapper/findings/drive_findings.h"
#include "tests/simulator/record.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::TempFolder;

const Drive& corner() {
  static const TempFolder folder;
  static const Drive drive = [] {
    const simulator::Town town = simulator::make_town(3);
    const simulator::Lighting lighting = simulator::light_town(town, simulator::noon_light());
    for (simulator::RunPlan run : simulator::make_runs(town.network, town.seed, 90)) {
      if (run.name != "town-loop-map") continue;
      run.camera = {160, 120, {120, 120, 80, 60}};
      EXPECT_TRUE(simulator::record(town, lighting, run, folder.path(), 2).ok());
    }
    return read_drive(folder.path()).value();
  }();
  return drive;
}

// Poses of so many frames later; the last ones, which have none, are left out.
Drive late(std::size_t frames) {
  Drive drive = corner();
  const std::size_t count = drive.frames.size() - frames;
  for (std::size_t i = 0; i < count; ++i) {
    drive.frames[i].position = corner().frames[i + frames].position;
    drive.frames[i].heading_deg = corner().frames[i + frames].heading_deg;
  }
  drive.frames.resize(count);
  return drive;
}

std::vector<Finding> found_in(const Drive& drive) {
  return image_findings(drive, steps_of(drive)).value();
}

TEST(ImageFindings, ASoundDriveHasNone) {
  EXPECT_THAT(drive_findings(std::vector{corner(), corner()}, 2).value(), IsEmpty());
}

TEST(ImageFindings, ClocksThatDiffer) {
  const std::vector<Finding> findings = found_in(late(4));
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].kind, "clock_offset");
  EXPECT_THAT(findings[0].what, HasSubstr("earlier than the images"));
}

TEST(ImageFindings, ImagesThatRepeat) {
  const TempFolder folder;
  fs::copy(corner().folder, folder.path(),
           fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  Drive drive = corner();
  drive.folder = folder.path();
  for (const std::size_t i : {11U, 12U}) {
    fs::copy_file(corner().frame_path(corner().frames[10]), drive.frame_path(drive.frames[i]),
                  fs::copy_options::overwrite_existing);
  }
  const std::vector<Finding> findings = found_in(drive);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].kind, "repeated_images");
  EXPECT_EQ(findings[0].line, 13U);
  EXPECT_EQ(findings[0].count, 2U);
}

TEST(ImageFindings, AnImageThatCannotBeReadIsAnError) {
  const TempFolder folder;
  Drive drive = corner();
  drive.folder = folder.path();
  const auto findings = image_findings(drive, steps_of(drive));
  ASSERT_FALSE(findings.ok());
  EXPECT_EQ(findings.error().code, ErrorCode::not_found);
}

}  // namespace
}  // namespace milepost
