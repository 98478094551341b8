// A recording of ROS: messages by topic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "mapper/import/ros/message_reader.h"
#include "schema/base/bytes.h"
#include "schema/base/result.h"

namespace milepost::ros {

struct BagTopic {
  std::string name;  // "/camera/image_raw"
  std::string type;  // "sensor_msgs/Image", of either generation
};

// Where a message lies.
struct MessagePlace {
  std::uint64_t part = 0;  // of the bag
  std::uint64_t at = 0;    // in the part
};

// Holds one part of the recording in memory at a time. Not safe to use from several threads.
class Bag {
 public:
  Bag() = default;
  Bag(const Bag&) = delete;
  Bag& operator=(const Bag&) = delete;
  virtual ~Bag() = default;

  virtual Serialization serialization() const = 0;
  virtual const std::vector<BagTopic>& topics() const = 0;

  // `topic` counts topics(). The view ends with the call.
  using Visit = std::function<Status(std::size_t topic, ByteView message, MessagePlace place)>;
  // Visits the messages of the topics in `wanted`, one entry for each topic, in their order in the
  // bag, until a visit fails. Errors: corrupt, io, those of `visit`.
  virtual Status visit_messages(const std::vector<bool>& wanted, const Visit& visit) = 0;

  // The message at a place that was visited; until the next call. Errors: corrupt, io.
  virtual Result<ByteView> message_at(MessagePlace place) = 0;
};

}  // namespace milepost::ros
