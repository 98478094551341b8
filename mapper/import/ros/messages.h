// The messages of ROS that an import reads, of either generation: both have the same fields.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "mapper/import/ros/message_reader.h"
#include "schema/base/bytes.h"
#include "schema/base/result.h"
#include "schema/geo/geodesy.h"

namespace milepost::ros {

inline constexpr const char* kImage = "sensor_msgs/Image";
inline constexpr const char* kCompressedImage = "sensor_msgs/CompressedImage";
inline constexpr const char* kCameraInfo = "sensor_msgs/CameraInfo";
inline constexpr const char* kNavSatFix = "sensor_msgs/NavSatFix";
inline constexpr const char* kImu = "sensor_msgs/Imu";
inline constexpr const char* kOdometry = "nav_msgs/Odometry";

inline constexpr std::uint32_t kMaxSidePx = 20000;  // of a drive's images (FORMAT.md 1.2)

// Times are those of header.stamp, in seconds since 1970. Views lie in the message's bytes.

struct Image {
  double timestamp_s = 0;
  std::uint32_t height_px = 0;
  std::uint32_t width_px = 0;
  std::string_view encoding;
  bool is_big_endian = false;
  std::uint32_t row_bytes = 0;
  ByteView pixels;
};

struct CompressedImage {
  double timestamp_s = 0;
  std::string_view format;
  ByteView file;
};

struct CameraInfo {
  std::uint32_t height_px = 0;  // of the full image
  std::uint32_t width_px = 0;
  std::string_view distortion_model;
  std::vector<double> distortion;
  std::array<double, 9> intrinsics{};   // row by row, of the image as taken
  std::array<double, 12> projection{};  // the same, of the rectified image
  std::uint32_t binning_x = 0;          // 0 is 1
  std::uint32_t binning_y = 0;
  std::uint32_t roi_x_px = 0;  // the part of the full image that was taken, before binning
  std::uint32_t roi_y_px = 0;
  std::uint32_t roi_height_px = 0;  // 0: all of it
  std::uint32_t roi_width_px = 0;
};

struct NavSatFix {
  double timestamp_s = 0;
  std::optional<GeoPoint> position;  // none: the receiver had none
};

// From the body, x forward, y left, z up (REP 103).
struct Imu {
  double timestamp_s = 0;
  std::optional<Eigen::Quaterniond> enu_from_body;  // none: not estimated
};

struct Odometry {
  double timestamp_s = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  std::optional<Eigen::Quaterniond> world_from_body;  // none: no unit quaternion
};

// Errors: corrupt; `where` is left to the caller.
Result<Image> decode_image(ByteView message, Serialization serialization);
Result<CompressedImage> decode_compressed_image(ByteView message, Serialization serialization);
Result<CameraInfo> decode_camera_info(ByteView message, Serialization serialization);
Result<NavSatFix> decode_nav_sat_fix(ByteView message, Serialization serialization);
Result<Imu> decode_imu(ByteView message, Serialization serialization);
Result<Odometry> decode_odometry(ByteView message, Serialization serialization);

}  // namespace milepost::ros
