// What the public localizers reject; that they work is tested by the example (system, install) and
// by the library's own tests.
#include <gtest/gtest.h>
#include <milepost/global_localizer.h>
#include <milepost/localizer.h>

#include <limits>
#include <vector>

#include "tests/support/scripted_server.h"
#include "tests/support/temp_folder.h"

namespace milepost::vehicle {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr int kSidePx = 8;

class PublicFace : public ::testing::Test {
 protected:
  static Camera camera() {
    Camera camera;
    camera.width_px = kSidePx;
    camera.height_px = kSidePx;
    camera.focal_x_px = 10;
    camera.focal_y_px = 10;
    return camera;
  }

  ServerSource no_server() const {
    ServerSource server;
    server.url = "http://127.0.0.1:1";
    server.cache_directory = (folder_.path() / "cache").string();
    return server;
  }

  ImageView image() const {
    return {pixels_.data(), kSidePx, kSidePx, kSidePx, PixelFormat::gray8};
  }

  testing::TempFolder folder_;
  std::vector<std::uint8_t> pixels_ = std::vector<std::uint8_t>(kSidePx * kSidePx, 0);
};

ReceiverReading reading_at(double timestamp_s) {
  ReceiverReading reading;
  reading.timestamp_s = timestamp_s;
  reading.latitude_deg = 49;
  reading.longitude_deg = 8.4;
  reading.sigma_m = 5;
  return reading;
}

TEST_F(PublicFace, RefusesReadingsThatAreNone) {
  auto localizer = Localizer::open(no_server(), camera());
  ASSERT_TRUE(localizer.ok());
  EXPECT_TRUE(localizer->observe(reading_at(10)).ok());
  EXPECT_FALSE(localizer->observe(reading_at(9)).ok());
  const auto refused = [&](auto change) {
    ReceiverReading reading = reading_at(11);
    change(reading);
    const Status status = localizer->observe(reading);
    return !status.ok() && status.error().code == ErrorCode::invalid_input;
  };
  EXPECT_TRUE(refused([](ReceiverReading& reading) { reading.timestamp_s = kNothing; }));
  EXPECT_TRUE(refused([](ReceiverReading& reading) { reading.latitude_deg = 91; }));
  EXPECT_TRUE(refused([](ReceiverReading& reading) { reading.sigma_m = 0; }));
  EXPECT_TRUE(refused([](ReceiverReading& reading) { reading.heading_deg = kNothing; }));
  EXPECT_TRUE(localizer->observe(OdometryReading{10, 8, 1}).ok());
  EXPECT_FALSE(localizer->observe(OdometryReading{10, 8, 1}).ok());
  EXPECT_FALSE(localizer->observe(OdometryReading{11, kNothing, 1}).ok());
  EXPECT_FALSE(localizer->observe(OdometryReading{11, 8, kNothing}).ok());
  EXPECT_TRUE(localizer->observe(OdometryReading{11, 8, 1}).ok());
}

TEST_F(PublicFace, RefusesRoutesThatAreNone) {
  auto localizer = Localizer::open(no_server(), camera());
  ASSERT_TRUE(localizer.ok());
  EXPECT_TRUE(localizer->expect_route({{49, 8.4}, {49.01, 8.4}}).ok());
  EXPECT_TRUE(localizer->expect_route({}).ok());
  const std::vector<std::vector<RoutePoint>> none = {
      {{49, 8.4}}, {{49, 8.4}, {49, 8.4}}, {{49, 8.4}, {91, 8.4}}, {{49, 8.4}, {kNothing, 8}}};
  for (const std::vector<RoutePoint>& route : none) {
    const Status refused = localizer->expect_route(route);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::invalid_input);
  }
}

TEST_F(PublicFace, RefusesImagesThatAreNoneAndTimesThatGoBack) {
  auto localizer = Localizer::open(no_server(), camera());
  ASSERT_TRUE(localizer.ok());
  const auto fix = localizer->localize(5, image());
  ASSERT_TRUE(fix.ok()) << fix.error().line();  // nothing was requested yet
  EXPECT_EQ(fix->status, FixStatus::initializing);
  EXPECT_FALSE(localizer->localize(5, image()).ok());
  EXPECT_FALSE(localizer->localize(kNothing, image()).ok());
  ImageView wrong = image();
  wrong.width_px = 7;
  EXPECT_FALSE(localizer->localize(6, wrong).ok());
  EXPECT_TRUE(localizer->localize(6, image()).ok());  // rejected calls had no effect
  EXPECT_EQ(localizer->fix_at(7).status, FixStatus::initializing);
}

TEST_F(PublicFace, WaitingForTheMapHasADeadlineAndCanBeCancelled) {
  testing::ScriptedServer silent_server([](const std::string&) {
    testing::ScriptedAnswer answer;
    answer.silent = true;
    return answer;
  });
  ServerSource silent = no_server();
  silent.url = silent_server.url();
  auto localizer = Localizer::open(silent, camera());
  ASSERT_TRUE(localizer.ok());
  ASSERT_TRUE(localizer->observe(reading_at(10)).ok());
  Patience none;
  none.longest = std::chrono::milliseconds(0);
  EXPECT_EQ(localizer->wait_for_map(10, none).error().code, ErrorCode::timed_out);
  Patience cancelled;
  cancelled.cancelled = [] { return true; };
  EXPECT_EQ(localizer->wait_for_map(10, cancelled).error().code, ErrorCode::cancelled);
  Patience later;  // while it waits
  const auto began = std::chrono::steady_clock::now();
  later.cancelled = [&] { return std::chrono::steady_clock::now() > began; };
  EXPECT_EQ(localizer->wait_for_map(10, later).error().code, ErrorCode::cancelled);
}

TEST_F(PublicFace, WaitingForTheMapEndsWhenItsRequestHasFailed) {
  auto localizer = Localizer::open(no_server(), camera());
  ASSERT_TRUE(localizer.ok());
  ASSERT_TRUE(localizer->observe(reading_at(10)).ok());
  EXPECT_TRUE(localizer->wait_for_map(10).ok());
  EXPECT_TRUE(localizer->map_ahead().failure.has_value());
}

TEST_F(PublicFace, RefusesSettingsOutOfRange) {
  LocalizerSettings settings;
  settings.ahead_m = -1;
  EXPECT_EQ(Localizer::open(no_server(), camera(), settings).error().code,
            ErrorCode::invalid_input);
  GlobalLocalizerSettings global_settings;
  global_settings.particles = 5;
  EXPECT_EQ(GlobalLocalizer::open(no_server(), camera(), global_settings).error().code,
            ErrorCode::invalid_input);
  global_settings = {};
  global_settings.area = Area{8.5, 49, 8.4, 49.1};
  EXPECT_EQ(GlobalLocalizer::open(no_server(), camera(), global_settings).error().code,
            ErrorCode::invalid_input);
  global_settings = {};
  global_settings.start = PosePrior{49, 8.4, 0};
  EXPECT_EQ(GlobalLocalizer::open(no_server(), camera(), global_settings).error().code,
            ErrorCode::invalid_input);
}

TEST_F(PublicFace, OpeningAGlobalLocalizerHasADeadlineAndCanBeCancelled) {
  Patience cancelled;
  cancelled.cancelled = [] { return true; };
  EXPECT_EQ(GlobalLocalizer::open(no_server(), camera(), {}, cancelled).error().code,
            ErrorCode::cancelled);
  Patience none;
  none.longest = std::chrono::milliseconds(0);
  EXPECT_EQ(GlobalLocalizer::open(no_server(), camera(), {}, none).error().code,
            ErrorCode::timed_out);
}

TEST(PublicNames, AreThoseOfTheFixes) {
  EXPECT_STREQ(name_of(FixStatus::off_map), "off-map");
  EXPECT_STREQ(name_of(FixStatus::tracking), "tracking");
  EXPECT_STREQ(name_of(GlobalStatus::lost), "lost");
}

}  // namespace
}  // namespace milepost::vehicle
