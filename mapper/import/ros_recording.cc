#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>

#include "mapper/import/layouts.h"
#include "mapper/import/local_poses.h"
#include "mapper/import/ros/bag.h"
#include "mapper/import/ros/camera_of_info.h"
#include "mapper/import/ros/image_files.h"
#include "mapper/import/ros/messages.h"
#include "mapper/import/ros/ros1_bag.h"
#include "mapper/import/ros/ros2_bag.h"
#include "mapper/import/ros_topics.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;

Error at_place(const Error& error, const std::string& place) {
  return {error.code, place, error.what, error.hint};
}

Status write_file(const fs::path& file, ByteView content) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(as_text(content).data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  if (stream) return ok_status();
  return Error{ErrorCode::io, file.string(), "cannot be written",
               "check the disk's space and the permissions"};
}

// The images of a topic, read from the bag once more when they are written.
class BagImages : public ImageContainer {
 public:
  BagImages(std::unique_ptr<ros::Bag> bag, std::string topic, bool are_compressed,
            std::vector<ros::MessagePlace> places)
      : bag_(std::move(bag)),
        topic_(std::move(topic)),
        are_compressed_(are_compressed),
        places_(std::move(places)) {}

  Status write(const RecordedImage& image, const fs::path& file) override {
    const auto message = bag_->message_at(places_[image.entry]);
    if (!message) return message.error();
    const Status written =
        are_compressed_ ? write_compressed(*message, file) : write_raw(*message, file);
    if (written || !written.error().where.empty()) return written;
    return at_place(written.error(), topic_ + ", image " + std::to_string(image.entry + 1));
  }

 private:
  Status write_raw(ByteView message, const fs::path& file) {
    const auto image = ros::decode_image(message, bag_->serialization());
    if (!image) return image.error();
    const auto png = ros::png_of(*image);
    if (!png) return png.error();
    return write_file(file, *png);
  }

  Status write_compressed(ByteView message, const fs::path& file) {
    const auto image = ros::decode_compressed_image(message, bag_->serialization());
    if (!image) return image.error();
    return write_file(file, image->file);
  }

  std::unique_ptr<ros::Bag> bag_;
  std::string topic_;
  bool are_compressed_;
  std::vector<ros::MessagePlace> places_;
};

// A camera (x right, y down, z forward) that looks along a body's x axis (REP 103: y left, z up).
Eigen::Isometry3d body_from_camera() {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return transform;
}

// Becomes a recording while a bag's messages pass.
class RosRecording {
 public:
  // Errors: invalid_input (topics that are not there or several, no --origin).
  static Result<RosRecording> begin(const ros::Bag& bag, const ImportOptions& options) {
    const auto chosen = ros_topics(bag.topics(), options);
    if (!chosen) return chosen.error();
    RosRecording reading(bag, options, *chosen);
    if (reading.has_odometrys_positions()) {
      const auto frame = frame_of_origin(options);
      if (!frame) return frame.error();
      reading.frame_ = *frame;
    }
    return reading;
  }

  std::vector<bool> wanted_topics() const {
    std::vector<bool> wanted(topics_.size(), false);
    wanted[chosen_.image] = true;
    wanted[chosen_.position] = true;
    if (chosen_.orientation) wanted[*chosen_.orientation] = true;
    if (chosen_.camera_info) wanted[*chosen_.camera_info] = true;
    return wanted;
  }

  Status add(std::size_t topic, ByteView message, ros::MessagePlace place) {
    ++counts_[topic];
    const Status added = add_message(topic, message, place);
    if (added) return added;
    return at_place(added.error(), file_ + ", " + topics_[topic].name + ", message " +
                                       std::to_string(counts_[topic]));
  }

  // Errors: invalid_input (a topic without a message that can be used).
  Result<Recording> finish(std::unique_ptr<ros::Bag> bag) {
    if (recording_.images.empty()) return holds_no(chosen_.image, "an image");
    if (recording_.poses.empty()) return holds_no(chosen_.position, "a position");
    const bool has_orientation = !recording_.orientations.empty();
    if (chosen_.orientation && chosen_.is_orientation_named && !has_orientation)
      return holds_no(*chosen_.orientation, "an orientation");
    recording_.has_headings = has_orientation;
    recording_.is_receivers = !has_odometrys_positions();
    name_images();
    const ros::BagTopic& images = topics_[chosen_.image];
    recording_.container =
        std::make_shared<BagImages>(std::move(bag), file_ + ", " + images.name,
                                    images.type == ros::kCompressedImage, std::move(places_));
    return std::move(recording_);
  }

 private:
  RosRecording(const ros::Bag& bag, const ImportOptions& options, const RosTopics& chosen)
      : file_(options.trajectory.string()),
        serialization_(bag.serialization()),
        topics_(bag.topics()),
        chosen_(chosen),
        counts_(topics_.size(), 0),
        enu_from_world_(Eigen::AngleAxisd(-options.origin_heading_deg * kRadPerDeg,
                                          Eigen::Vector3d::UnitZ())) {}

  bool has_odometrys_positions() const { return topics_[chosen_.position].type == ros::kOdometry; }

  Error holds_no(std::size_t topic, const std::string& what) const {
    return {ErrorCode::invalid_input, file_ + ", " + topics_[topic].name,
            "none of " + std::to_string(counts_[topic]) + " messages holds " + what,
            "choose another topic with --topics, or name another bag"};
  }

  Status add_message(std::size_t topic, ByteView message, ros::MessagePlace place) {
    if (topic == chosen_.image) return add_image(message, place);
    if (topic == chosen_.camera_info) return add_camera(message);
    if (topic == chosen_.position)
      if (const Status added = add_position(message); !added) return added;
    return topic == chosen_.orientation ? add_orientation(message) : ok_status();
  }

  Status add_image(ByteView message, ros::MessagePlace place) {
    if (topics_[chosen_.image].type == ros::kImage) {
      const auto image = ros::decode_image(message, serialization_);
      if (!image) return image.error();
      if (const Status checked = ros::check_image(*image); !checked) return checked;
      recording_.images.push_back({".png", image->timestamp_s, places_.size()});
    } else {
      const auto image = ros::decode_compressed_image(message, serialization_);
      if (!image) return image.error();
      const auto ending = ros::ending_of(*image);
      if (!ending) return ending.error();
      recording_.images.push_back({*ending, image->timestamp_s, places_.size()});
    }
    places_.push_back(place);
    return ok_status();
  }

  // The first that is calibrated.
  Status add_camera(ByteView message) {
    if (recording_.camera) return ok_status();
    const auto info = ros::decode_camera_info(message, serialization_);
    if (!info) return info.error();
    const auto camera = ros::camera_of(*info, is_rectified(topics_[chosen_.image].name));
    if (!camera) return camera.error();
    recording_.camera = *camera;
    return ok_status();
  }

  Status add_position(ByteView message) {
    if (!has_odometrys_positions()) {
      const auto fix = ros::decode_nav_sat_fix(message, serialization_);
      if (!fix) return fix.error();
      if (fix->position) recording_.poses.push_back({fix->timestamp_s, {*fix->position}});
      return ok_status();
    }
    const auto odometry = ros::decode_odometry(message, serialization_);
    if (!odometry) return odometry.error();
    const Eigen::Vector3d enu_m = enu_from_world_ * odometry->position_m;
    if (enu_m.allFinite()) {
      recording_.poses.push_back(
          {odometry->timestamp_s, {frame_->geo_from_enu({enu_m.x(), enu_m.y(), enu_m.z()})}});
    }
    return ok_status();
  }

  Status add_orientation(ByteView message) {
    if (topics_[*chosen_.orientation].type == ros::kImu) {
      const auto imu = ros::decode_imu(message, serialization_);
      if (!imu) return imu.error();
      if (imu->enu_from_body) add_rotation(imu->timestamp_s, *imu->enu_from_body);
      return ok_status();
    }
    const auto odometry = ros::decode_odometry(message, serialization_);
    if (!odometry) return odometry.error();
    if (odometry->world_from_body) add_rotation(odometry->timestamp_s, *odometry->world_from_body);
    return ok_status();
  }

  void add_rotation(double timestamp_s, const Eigen::Quaterniond& world_from_body) {
    static const LocalFrame kAnywhere{GeoPoint()};  // positions are not used
    const Eigen::Isometry3d enu_from_camera =
        enu_from_world_ * Eigen::Isometry3d(world_from_body) * body_from_camera();
    const GeoAttitude attitude = attitude_of(enu_from_camera, kAnywhere);
    recording_.orientations.push_back({timestamp_s, attitude});
    // Odometry in the plane tells no tilts.
    constexpr double kLevelDeg = 1e-6;
    recording_.has_tilts = recording_.has_tilts || std::abs(attitude.pitch_deg) > kLevelDeg ||
                           std::abs(attitude.roll_deg) > kLevelDeg;
  }

  // Numbers in the order of time; until now the names are endings.
  void name_images() {
    std::ranges::stable_sort(recording_.images, {}, &RecordedImage::timestamp_s);
    for (std::size_t i = 0; i < recording_.images.size(); ++i) {
      std::string number = std::to_string(i);
      number.insert(0, 6 - std::min<std::size_t>(6, number.size()), '0');
      fs::path& file = recording_.images[i].file;
      file = number + file.string();
    }
  }

  std::string file_;
  ros::Serialization serialization_;
  std::vector<ros::BagTopic> topics_;
  RosTopics chosen_;
  std::vector<std::size_t> counts_;  // messages by topic
  Eigen::Isometry3d enu_from_world_;
  std::optional<LocalFrame> frame_;  // of odometry's positions
  Recording recording_;
  std::vector<ros::MessagePlace> places_;  // of the images
};

Result<Recording> read_bag(Result<std::unique_ptr<ros::Bag>> opened, const ImportOptions& options) {
  if (!opened) return opened.error();
  std::unique_ptr<ros::Bag> bag = std::move(*opened);
  auto reading = RosRecording::begin(*bag, options);
  if (!reading) return reading.error();
  const Status visited = bag->visit_messages(
      reading->wanted_topics(), [&](std::size_t topic, ByteView message, ros::MessagePlace place) {
        return reading->add(topic, message, place);
      });
  if (!visited) return visited.error();
  return reading->finish(std::move(bag));
}

}  // namespace

Result<Recording> read_ros1(const ImportOptions& options) {
  return read_bag(ros::open_ros1_bag(options.trajectory), options);
}

Result<Recording> read_ros2(const ImportOptions& options) {
  return read_bag(ros::open_ros2_bag(options.trajectory), options);
}

}  // namespace milepost
