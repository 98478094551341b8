// Bags of ROS and their messages. The first byte chooses: '1' a .bag, '2' a .db3, 'r' a message of
// ROS 1, 'd' one of ROS 2 (CDR).
#include <cstdint>
#include <vector>

#include "mapper/import/ros/messages.h"
#include "mapper/import/ros/ros1_bag.h"
#include "mapper/import/ros/ros2_bag.h"
#include "tests/fuzz/check.h"
#include "tests/fuzz/scratch_file.h"

namespace {

using namespace milepost;

bool lies_in(ByteView part, ByteView whole) {
  return part.empty() ||
         (part.data() >= whole.data() && part.data() + part.size() <= whole.data() + whole.size());
}

// As each of the messages that are read; what is a view lies in the message.
void decode(ByteView message, ros::Serialization serialization) {
  if (const auto image = ros::decode_image(message, serialization); image) {
    fuzz::check(lies_in(image->pixels, message));
    fuzz::check(lies_in(as_bytes(image->encoding), message));
  }
  if (const auto image = ros::decode_compressed_image(message, serialization); image) {
    fuzz::check(lies_in(image->file, message));
  }
  if (const auto info = ros::decode_camera_info(message, serialization); info) {
    fuzz::check(8 * info->distortion.size() <= message.size());
  }
  const auto fix = ros::decode_nav_sat_fix(message, serialization);
  if (fix && fix->position) fuzz::check(is_valid(*fix->position));
  static_cast<void>(ros::decode_imu(message, serialization));
  static_cast<void>(ros::decode_odometry(message, serialization));
}

// Messages are found again where they were seen.
void read(Result<std::unique_ptr<ros::Bag>> bag) {
  if (!bag) return;
  struct Seen {
    Bytes message;
    ros::MessagePlace place;
  };
  constexpr std::size_t kMost = 20;
  std::vector<Seen> seen;
  const std::vector<bool> all((*bag)->topics().size(), true);
  const Status visited = (*bag)->visit_messages(
      all, [&](std::size_t topic, ByteView message, ros::MessagePlace place) {
        fuzz::check(topic < (*bag)->topics().size());
        decode(message, (*bag)->serialization());
        if (seen.size() < kMost) seen.push_back({{message.begin(), message.end()}, place});
        return ok_status();
      });
  if (!visited) return;
  for (const Seen& each : seen) {
    const auto again = (*bag)->message_at(each.place);
    fuzz::check(again.ok() && Bytes(again->begin(), again->end()) == each.message);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const ByteView content(data + 1, size - 1);
  switch (data[0]) {
    case '1': {
      static const fuzz::ScratchFile file(".bag");
      file.write(content.data(), content.size());
      read(ros::open_ros1_bag(file.path()));
      break;
    }
    case '2': {
      static const fuzz::ScratchFile file(".db3");
      file.write(content.data(), content.size());
      read(ros::open_ros2_bag(file.path()));
      break;
    }
    case 'r':
      decode(content, ros::Serialization::ros1);
      break;
    case 'd':
      decode(content, ros::Serialization::cdr);
      break;
    default:
      break;
  }
  return 0;
}
