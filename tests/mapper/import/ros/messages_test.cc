#include "mapper/import/ros/messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "tests/mapper/import/ros/message_writer.h"

namespace milepost::ros {
namespace {

using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::MessageWriter;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class Messages : public ::testing::TestWithParam<Serialization> {
 protected:
  MessageWriter begin() const {
    MessageWriter writer(GetParam());
    writer.header();
    return writer;
  }
  Bytes image() const {
    return begin()
        .number(std::uint32_t{2})
        .number(std::uint32_t{3})
        .text("mono8")
        .number(std::uint8_t{1})
        .number(std::uint32_t{4})
        .bytes({1, 2, 3, 0, 4, 5, 6, 0})
        .message();
  }
  Bytes compressed_image() const { return begin().text("jpeg").bytes({0xff, 0xd8}).message(); }
  Bytes camera_info() const {
    return begin()
        .number(std::uint32_t{500})
        .number(std::uint32_t{600})
        .text("plumb_bob")
        .number(std::uint32_t{2})
        .doubles({0.1, 0.2})
        .doubles({1, 2, 3, 4, 5, 6, 7, 8, 9})
        .doubles(9, 0)
        .doubles({11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22})
        .number(std::uint32_t{1})
        .number(std::uint32_t{2})
        .number(std::uint32_t{3})
        .number(std::uint32_t{4})
        .number(std::uint32_t{5})
        .number(std::uint32_t{6})
        .number(std::uint8_t{1})
        .message();
  }
  Bytes fix(std::int8_t status, double latitude_deg, double altitude_m = 115) const {
    return begin()
        .number(status)
        .number(std::uint16_t{1})
        .doubles({latitude_deg, 8.4, altitude_m})
        .doubles(9, 1)
        .number(std::uint8_t{2})
        .message();
  }
  Bytes imu(double w, double covariance = 0) const {
    return begin()
        .doubles({0, 0, 0.6, w})
        .number(covariance)
        .doubles(8, 0)
        .doubles(24, 0)
        .message();
  }
  Bytes odometry(double w) const {
    return begin()
        .text("base_link")
        .doubles({1, 2, 3})
        .doubles({0, 0, 0.6, w})
        .doubles(36, 0)
        .doubles(42, 0)
        .message();
  }
};

INSTANTIATE_TEST_SUITE_P(Of, Messages, ::testing::Values(Serialization::ros1, Serialization::cdr),
                         [](const auto& each) {
                           return each.param == Serialization::ros1 ? "Ros1" : "Ros2";
                         });

TEST_P(Messages, Images) {
  const Bytes message = image();
  const auto raw = decode_image(message, GetParam());
  ASSERT_TRUE(raw.ok()) << raw.error().line();
  EXPECT_EQ(raw->timestamp_s, 12.5);
  EXPECT_EQ(raw->height_px, 2U);
  EXPECT_EQ(raw->width_px, 3U);
  EXPECT_EQ(raw->encoding, "mono8");
  EXPECT_TRUE(raw->is_big_endian);
  EXPECT_EQ(raw->row_bytes, 4U);
  EXPECT_THAT(raw->pixels, ElementsAre(1, 2, 3, 0, 4, 5, 6, 0));
  const Bytes small = compressed_image();
  const auto compressed = decode_compressed_image(small, GetParam());
  ASSERT_TRUE(compressed.ok()) << compressed.error().line();
  EXPECT_EQ(compressed->timestamp_s, 12.5);
  EXPECT_EQ(compressed->format, "jpeg");
  EXPECT_THAT(compressed->file, ElementsAre(0xff, 0xd8));
}

TEST_P(Messages, CameraInfos) {
  const Bytes message = camera_info();
  const auto info = decode_camera_info(message, GetParam());
  ASSERT_TRUE(info.ok()) << info.error().line();
  EXPECT_EQ(info->height_px, 500U);
  EXPECT_EQ(info->width_px, 600U);
  EXPECT_EQ(info->distortion_model, "plumb_bob");
  EXPECT_THAT(info->distortion, ElementsAre(0.1, 0.2));
  EXPECT_THAT(info->intrinsics, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9));
  EXPECT_EQ(info->projection[6], 17);
  EXPECT_EQ(info->binning_x, 1U);
  EXPECT_EQ(info->binning_y, 2U);
  EXPECT_EQ(info->roi_x_px, 3U);
  EXPECT_EQ(info->roi_y_px, 4U);
  EXPECT_EQ(info->roi_height_px, 5U);
  EXPECT_EQ(info->roi_width_px, 6U);
}

TEST_P(Messages, FixesWithoutAPositionHaveNone) {
  const Bytes sound = fix(0, 49);
  const auto decoded = decode_nav_sat_fix(sound, GetParam());
  ASSERT_TRUE(decoded.ok()) << decoded.error().line();
  EXPECT_EQ(decoded->timestamp_s, 12.5);
  EXPECT_EQ(decoded->position, (GeoPoint{49, 8.4, 115}));
  for (const Bytes& none : {fix(-1, 49), fix(0, kNan), fix(0, 91), fix(0, 49, kNan)}) {
    const auto without = decode_nav_sat_fix(none, GetParam());
    ASSERT_TRUE(without.ok()) << without.error().line();
    EXPECT_FALSE(without->position);
  }
}

TEST_P(Messages, OrientationsThatAreNoneAreLeftOut) {
  const Bytes sound = imu(0.8);
  const auto decoded = decode_imu(sound, GetParam());
  ASSERT_TRUE(decoded.ok()) << decoded.error().line();
  ASSERT_TRUE(decoded->enu_from_body);
  EXPECT_NEAR(decoded->enu_from_body->w(), 0.8, 1e-12);
  EXPECT_NEAR(decoded->enu_from_body->z(), 0.6, 1e-12);
  for (const Bytes& none : {imu(0.8, -1), imu(0), imu(kNan)}) {
    const auto without = decode_imu(none, GetParam());
    ASSERT_TRUE(without.ok()) << without.error().line();
    EXPECT_FALSE(without->enu_from_body);
  }
}

TEST_P(Messages, Odometry) {
  const Bytes sound = odometry(0.8);
  const auto decoded = decode_odometry(sound, GetParam());
  ASSERT_TRUE(decoded.ok()) << decoded.error().line();
  EXPECT_EQ(decoded->position_m, Eigen::Vector3d(1, 2, 3));
  ASSERT_TRUE(decoded->world_from_body);
  EXPECT_NEAR(decoded->world_from_body->w(), 0.8, 1e-12);
}

// Every message that is cut anywhere, or goes on, is refused.
TEST_P(Messages, OfAnotherLengthAreRefused) {
  using Refusal = std::function<std::string(ByteView)>;
  const auto refusal = [this](auto decode) -> Refusal {
    return [this, decode](ByteView message) -> std::string {
      const auto decoded = decode(message, GetParam());
      return decoded ? "accepted" : decoded.error().line();
    };
  };
  const std::vector<std::pair<Bytes, Refusal>> messages = {
      {image(), refusal(decode_image)},
      {compressed_image(), refusal(decode_compressed_image)},
      {camera_info(), refusal(decode_camera_info)},
      {fix(0, 49), refusal(decode_nav_sat_fix)},
      {imu(0.8), refusal(decode_imu)},
      {odometry(0.8), refusal(decode_odometry)}};
  for (const auto& [message, refusal_of] : messages) {
    ASSERT_EQ(refusal_of(message), "accepted");
    for (std::size_t size = 0; size < message.size(); ++size) {
      EXPECT_THAT(refusal_of(ByteView(message).first(size)),
                  AnyOf(HasSubstr("is cut short"), HasSubstr("is not serialised as CDR")))
          << size;
    }
    Bytes longer = message;
    longer.resize(longer.size() + 4);
    EXPECT_THAT(refusal_of(longer), HasSubstr("has 4 bytes too many"));
  }
}

}  // namespace
}  // namespace milepost::ros
