// The readings of a drive's sensors in order of time.
#include "client/evaluate/drive_playback.h"

#include <gmock/gmock.h>

#include <vector>

namespace milepost {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

template <class Reading>
std::vector<double> times_of(std::span<const Reading> readings) {
  std::vector<double> times_s;
  for (const Reading& reading : readings) times_s.push_back(reading.timestamp_s);
  return times_s;
}

TEST(SensorLog, ReturnsEachReadingOnceItsTimeHasCome) {
  Drive drive;
  drive.odometry = {{1.0, 5, 0}, {1.1, 5, 0}, {1.2, 5, 0}, {1.3, 5, 0}};
  drive.gps = {{1.0, {}, 3}, {2.0, {}, 3}};
  SensorLog log(drive);
  EXPECT_THAT(times_of(log.odometry_until(0.9)), IsEmpty());
  EXPECT_THAT(times_of(log.odometry_until(1.1)), ElementsAre(1.0, 1.1));
  EXPECT_THAT(times_of(log.odometry_until(1.19)), IsEmpty());
  EXPECT_THAT(times_of(log.odometry_until(9)), ElementsAre(1.2, 1.3));
  EXPECT_THAT(times_of(log.odometry_until(10)), IsEmpty());
  EXPECT_THAT(times_of(log.gps_until(1.5)), ElementsAre(1.0));
  EXPECT_THAT(times_of(log.gps_until(2)), ElementsAre(2.0));
}

TEST(SensorLog, AReceiversTimeRoundedUpIsInTime) {
  Drive drive;
  drive.gps = {{1.001, {}, 3}, {1.5, {}, 3}};
  drive.odometry = {{1.001, 5, 0}};
  SensorLog log(drive);
  EXPECT_THAT(times_of(log.gps_until(1.0004)), ElementsAre(1.001));
  EXPECT_THAT(times_of(log.gps_until(1.4985)), IsEmpty());
  EXPECT_THAT(times_of(log.odometry_until(1.0004)), IsEmpty());
}

TEST(IgnoredReceiver, ReadingsAfterItsTimeAreGone) {
  Drive drive;
  drive.frames.resize(2);
  drive.frames[0].timestamp_s = 100.0004;
  for (const double timestamp_s : {99.0, 100.001, 101.0, 103.0})
    drive.gps.push_back({timestamp_s, {}, 5});
  Drive some = drive;
  ignore_receiver_after(some, 1);
  EXPECT_EQ(some.gps.size(), 3U);
  ignore_receiver_after(drive, 0);
  ASSERT_EQ(drive.gps.size(), 2U);  // that of the first frame, rounded up, is not after it
  EXPECT_EQ(drive.gps.back().timestamp_s, 100.001);
}

}  // namespace
}  // namespace milepost
