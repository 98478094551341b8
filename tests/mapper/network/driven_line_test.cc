#include "mapper/network/driven_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/mapper/network/drawn_roads.h"

namespace milepost {
namespace {

using testing::DrawnRoads;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::PlanPoint;
using ::testing::SizeIs;

// Records a drive by driving it.
class Recorder {
 public:
  explicit Recorder(double spacing_m = 2) : spacing_m_(spacing_m) { drive_.name = "a"; }

  // Backwards if negative; the vehicle keeps its heading.
  Recorder& go(double length_m, double turn_deg = 0) {
    const auto steps = std::lround(std::abs(length_m) / spacing_m_);
    for (long i = 0; i < steps; ++i) {
      heading_deg_ += turn_deg / static_cast<double>(steps);
      move(std::copysign(spacing_m_, length_m));
      record();
    }
    return *this;
  }
  // Stands, while its positions drift within a radius of 0.6 m.
  Recorder& stand(int frames) {
    const PlanPoint place = place_;
    std::mt19937 random(7);
    double angle = 0;
    for (int i = 0; i < frames; ++i) {
      angle += std::normal_distribution<double>(0, 0.3)(random);
      place_ = {place.east_m + 0.6 * std::cos(angle), place.north_m + 0.6 * std::sin(3 * angle)};
      record();
    }
    place_ = place;
    return *this;
  }
  // Goes on without recording.
  Recorder& pause(double length_m, double duration_s) {
    move(length_m);
    time_s_ += duration_s;
    return *this;
  }
  const Drive& drive() const { return drive_; }

 private:
  void move(double length_m) {
    place_.east_m += length_m * std::sin(heading_deg_ * kRadPerDeg);
    place_.north_m += length_m * std::cos(heading_deg_ * kRadPerDeg);
  }
  void record() {
    time_s_ += 0.2;
    drive_.frames.push_back({std::to_string(drive_.frames.size()), time_s_,
                             DrawnRoads::geo_of(place_, 0), wrapped_360(heading_deg_), 0});
  }

  double spacing_m_;
  PlanPoint place_;
  double heading_deg_ = 30;
  double time_s_ = 0;
  Drive drive_;
};

NamedDrivenLines lines_of(const Recorder& recorded, const DrivenLineSettings& settings = {}) {
  return driven_lines(recorded.drive(), settings).value();
}

TEST(DrivenLines, ADriveWithoutPauseIsOneLineOfAllItsFrames) {
  const Recorder recorded = Recorder().go(100).go(20, 90).go(80);
  const NamedDrivenLines drive = lines_of(recorded);
  ASSERT_THAT(drive.lines, SizeIs(1));
  EXPECT_EQ(drive.name, "a");
  EXPECT_EQ(drive.lines[0].frames.size(), recorded.drive().frames.size());
  EXPECT_EQ(drive.lines[0].line.vertices().size(), drive.lines[0].frames.size());
  EXPECT_NEAR(drive.lines[0].line.length_m(), 198, 0.1);
  EXPECT_THAT(drive.findings, IsEmpty());
}

TEST(DrivenLines, AStandingVehicleThatDriftsAddsNoLength) {
  for (const double spacing_m : {0.3, 1.0, 2.0}) {
    const NamedDrivenLines drive =
        lines_of(Recorder().go(100).stand(600).go(100), {.min_frame_spacing_m = spacing_m});
    ASSERT_THAT(drive.lines, SizeIs(1));
    EXPECT_NEAR(drive.lines[0].line.length_m(), 198, 1.3);
    EXPECT_THAT(drive.findings, IsEmpty());
  }
}

TEST(DrivenLines, APauseIsNotBridged) {
  for (const auto& [length_m, duration_s] : {std::pair{84.0, 6.0}, {20.0, 0.2}, {8.0, 60.0}}) {
    const NamedDrivenLines drive = lines_of(Recorder().go(100).pause(length_m, duration_s).go(60));
    ASSERT_THAT(drive.lines, SizeIs(2)) << length_m;
    EXPECT_NEAR(drive.lines[0].line.length_m(), 98, 0.1);
    EXPECT_NEAR(drive.lines[1].line.length_m(), 58, 0.1);
    ASSERT_THAT(drive.findings, SizeIs(1));
    EXPECT_THAT(drive.findings[0].what, HasSubstr("pause"));
    EXPECT_THAT(drive.findings[0].where, HasSubstr("'a', frame 49"));
  }
}

TEST(DrivenLines, AMissingFrameOrAWaitIsNoPause) {
  for (const auto& [length_m, duration_s] : {std::pair{10.0, 1.0}, {0.5, 300.0}}) {
    const NamedDrivenLines drive = lines_of(Recorder().go(100).pause(length_m, duration_s).go(60));
    EXPECT_THAT(drive.lines, SizeIs(1));
    EXPECT_THAT(drive.findings, IsEmpty());
  }
}

TEST(DrivenLines, FramesFarApartAreNoPausesIfAllAre) {
  EXPECT_THAT(lines_of(Recorder(20).go(400)).lines, SizeIs(1));
}

TEST(DrivenLines, ReversingIsLeftOut) {
  const NamedDrivenLines drive = lines_of(Recorder().go(100).go(-20).go(120));
  ASSERT_THAT(drive.lines, SizeIs(1));
  EXPECT_NEAR(drive.lines[0].line.length_m(), 198, 0.1);
  ASSERT_THAT(drive.findings, SizeIs(1));
  EXPECT_THAT(drive.findings[0].what, HasSubstr("reversed by 20 m"));
}

TEST(DrivenLines, ReversingAtTheEndIsLeftOut) {
  const NamedDrivenLines drive = lines_of(Recorder().go(100).go(-40));
  ASSERT_THAT(drive.lines, SizeIs(1));
  EXPECT_NEAR(drive.lines[0].line.length_m(), 98, 0.1);
  EXPECT_THAT(drive.findings, SizeIs(1));
}

TEST(DrivenLines, GoingOnElsewhereAfterReversingBeginsAnotherLine) {
  // A turn in three moves: 4 m across, back to the other side, and away.
  const NamedDrivenLines drive = lines_of(Recorder().go(100).go(6, 70).go(-6, 70).go(100, 40));
  ASSERT_THAT(drive.lines, SizeIs(2));
  EXPECT_NEAR(drive.lines[0].line.length_m(), 104, 0.5);
  EXPECT_NEAR(drive.lines[1].line.length_m(), 100, 0.5);
  EXPECT_THAT(drive.findings, SizeIs(1));
}

TEST(DrivenLines, ErrorsAreNamed) {
  const Result<NamedDrivenLines> standing = driven_lines(Recorder().stand(100).drive(), {});
  ASSERT_FALSE(standing.ok());
  EXPECT_THAT(standing.error().what, HasSubstr("does not move"));
  Drive nameless = Recorder().go(100).drive();
  nameless.name = "a b";
  const Result<NamedDrivenLines> refused = driven_lines(nameless, {});
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().what, HasSubstr("'a b'"));
}

}  // namespace
}  // namespace milepost
