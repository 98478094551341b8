#include "mapper/pipeline/mapping_log.h"

#include <gtest/gtest.h>

namespace milepost {
namespace {

ImageWitness witness(double plan_m, std::size_t tracks, std::size_t fitting) {
  return {.frames = 1, .plan_m2 = plan_m * plan_m, .tracks = tracks, .fitting = fitting};
}

TEST(MappingLog, FramesAddUpByDriveAndByTenMetresOfASegment) {
  milepost::Drive drive;
  drive.name = "monday";
  MappingLog log;
  log.add(drive, {"s1", 3, witness(0.03, 10, 10)});
  log.add(drive, {"s1", 9.9, witness(0.04, 10, 5)});
  log.add(drive, {"s1", 10, witness(0, 4, 4)});
  log.add(drive, {"s2", 1, witness(0, 1, 1)});
  log.add(drive, {"", 0, witness(0, 2, 0)});
  EXPECT_EQ(log.of_drive("monday").frames, 5U);
  EXPECT_EQ(log.of_drive("monday").tracks, 27U);
  EXPECT_EQ(log.of_drive("tuesday").frames, 0U);

  const MappingRecord record = log.record_of({"s1"});
  ASSERT_EQ(record.drives.size(), 1U);
  EXPECT_EQ(record.drives[0].fit.followed, 27U);
  ASSERT_EQ(record.segments.size(), 1U);  // the other segment is in another map
  const std::vector<StretchFit>& stretches = record.segments.at("s1");
  ASSERT_EQ(stretches.size(), 2U);
  EXPECT_EQ(stretches[0].from_m, 0);
  EXPECT_EQ(stretches[0].to_m, 10);
  EXPECT_EQ(stretches[0].drive, "monday");
  EXPECT_EQ(stretches[0].fit.frames, 2U);
  EXPECT_EQ(stretches[0].fit.fitting, 15U);
  EXPECT_NEAR(stretches[0].fit.plan_rms_m, 0.0354, 1e-4);
  EXPECT_EQ(stretches[1].from_m, 10);
}

TEST(MappingLog, FindingsNameDrivesAndNoFolders) {
  milepost::Drive one;
  one.name = "one";
  one.folder = "/data/drives/a";
  milepost::Drive two;
  two.name = "two";
  two.folder = "/data/drives/ab";
  MappingLog log;
  log.add({{"position_noise", "/data/drives/ab/trajectory.csv", 7, 3, "noise", "smooth"},
           {"copied_drive", "/data/drives/a, 120 m", 0, 1, "a copy of /data/drives/ab", ""}},
          {&one, &two});
  const std::vector<RecordedFinding> found = log.record_of({}).findings;
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].drive, "one");
  EXPECT_EQ(found[0].where, "120 m");
  EXPECT_EQ(found[0].what, "a copy of two");
  EXPECT_EQ(found[1].drive, "two");
  EXPECT_EQ(found[1].where, "trajectory.csv");
  EXPECT_EQ(found[1].row, 7U);
  EXPECT_EQ(found[1].count, 3U);
}

}  // namespace
}  // namespace milepost
