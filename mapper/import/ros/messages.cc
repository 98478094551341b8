#include "mapper/import/ros/messages.h"

#include <cmath>

namespace milepost::ros {
namespace {

// header: the time that the message is about.
double read_stamp(MessageReader& reader) {
  const bool is_ros1 = reader.serialization() == Serialization::ros1;
  if (is_ros1) reader.number<std::uint32_t>();  // seq
  const double seconds = is_ros1 ? reader.number<std::uint32_t>() : reader.number<std::int32_t>();
  const double nanoseconds = reader.number<std::uint32_t>();
  reader.text();  // frame_id
  return seconds + 1e-9 * nanoseconds;
}

std::optional<Eigen::Quaterniond> read_rotation(MessageReader& reader) {
  const auto [x, y, z, w] = reader.numbers<double, 4>();
  const Eigen::Quaterniond rotation(w, x, y, z);
  if (!(std::abs(rotation.norm() - 1) < 0.01)) return std::nullopt;
  return rotation.normalized();
}

template <class Message>
Result<Message> finished(const MessageReader& reader, Message message) {
  if (const Status finish = reader.finish(); !finish) return finish.error();
  return message;
}

}  // namespace

Result<Image> decode_image(ByteView message, Serialization serialization) {
  MessageReader reader(message, serialization);
  Image image;
  image.timestamp_s = read_stamp(reader);
  image.height_px = reader.number<std::uint32_t>();
  image.width_px = reader.number<std::uint32_t>();
  image.encoding = reader.text();
  image.is_big_endian = reader.number<std::uint8_t>() != 0;
  image.row_bytes = reader.number<std::uint32_t>();
  image.pixels = reader.bytes();
  return finished(reader, image);
}

Result<CompressedImage> decode_compressed_image(ByteView message, Serialization serialization) {
  MessageReader reader(message, serialization);
  CompressedImage image;
  image.timestamp_s = read_stamp(reader);
  image.format = reader.text();
  image.file = reader.bytes();
  return finished(reader, image);
}

Result<CameraInfo> decode_camera_info(ByteView message, Serialization serialization) {
  MessageReader reader(message, serialization);
  CameraInfo info;
  read_stamp(reader);
  info.height_px = reader.number<std::uint32_t>();
  info.width_px = reader.number<std::uint32_t>();
  info.distortion_model = reader.text();
  info.distortion = reader.doubles();
  info.intrinsics = reader.numbers<double, 9>();
  reader.numbers<double, 9>();  // R
  info.projection = reader.numbers<double, 12>();
  info.binning_x = reader.number<std::uint32_t>();
  info.binning_y = reader.number<std::uint32_t>();
  info.roi_x_px = reader.number<std::uint32_t>();
  info.roi_y_px = reader.number<std::uint32_t>();
  info.roi_height_px = reader.number<std::uint32_t>();
  info.roi_width_px = reader.number<std::uint32_t>();
  reader.number<std::uint8_t>();  // do_rectify
  return finished(reader, std::move(info));
}

Result<NavSatFix> decode_nav_sat_fix(ByteView message, Serialization serialization) {
  MessageReader reader(message, serialization);
  NavSatFix fix;
  fix.timestamp_s = read_stamp(reader);
  const auto status = reader.number<std::int8_t>();
  reader.number<std::uint16_t>();  // service
  const auto [latitude_deg, longitude_deg, altitude_m] = reader.numbers<double, 3>();
  reader.numbers<double, 9>();    // position_covariance
  reader.number<std::uint8_t>();  // position_covariance_type
  const GeoPoint position{latitude_deg, longitude_deg, altitude_m};
  if (status >= 0 && is_valid(position) && std::isfinite(altitude_m)) fix.position = position;
  return finished(reader, fix);
}

Result<Imu> decode_imu(ByteView message, Serialization serialization) {
  MessageReader reader(message, serialization);
  Imu imu;
  imu.timestamp_s = read_stamp(reader);
  imu.enu_from_body = read_rotation(reader);
  const auto orientation_covariance = reader.numbers<double, 9>();
  reader.numbers<double, 12>();  // angular_velocity and its covariance
  reader.numbers<double, 12>();  // linear_acceleration and its covariance
  if (orientation_covariance.front() == -1) imu.enu_from_body.reset();
  return finished(reader, imu);
}

Result<Odometry> decode_odometry(ByteView message, Serialization serialization) {
  MessageReader reader(message, serialization);
  Odometry odometry;
  odometry.timestamp_s = read_stamp(reader);
  reader.text();  // child_frame_id
  const auto [x, y, z] = reader.numbers<double, 3>();
  odometry.position_m = {x, y, z};
  odometry.world_from_body = read_rotation(reader);
  reader.numbers<double, 36>();  // covariance of the pose
  reader.numbers<double, 42>();  // twist and its covariance
  return finished(reader, odometry);
}

}  // namespace milepost::ros
