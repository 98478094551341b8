// Which topics of a bag are read as what.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "mapper/import/recording.h"
#include "mapper/import/ros/bag.h"
#include "schema/base/result.h"

namespace milepost {

struct RosTopics {
  std::size_t image = 0;
  std::size_t position = 0;
  std::optional<std::size_t> orientation;  // none: headings are told by the motion
  bool is_orientation_named = false;       // the user wants that topic's
  std::optional<std::size_t> camera_info;  // none: the camera is told by the user
};

// As --topics says, or the only topic of a fitting type: positions are those of a receiver, else of
// odometry, whose orientation goes with them; a camera's description lies beside its images.
// Errors: invalid_input, which names the topics that there are.
Result<RosTopics> ros_topics(const std::vector<ros::BagTopic>& topics,
                             const ImportOptions& options);

// Whether a topic has rectified images, by the name that ROS' image pipeline gives them.
bool is_rectified(const std::string& image_topic);

}  // namespace milepost
