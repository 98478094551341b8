// A bag of ROS 1: a .bag file of format 2.0.
#pragma once

#include <filesystem>
#include <memory>

#include "mapper/import/ros/bag.h"
#include "schema/base/result.h"

namespace milepost::ros {

// Opens a bag and reads its index; messages are read chunk by chunk. Errors: not_found, io,
// corrupt; invalid_input (no bag of this format, encrypted, not closed by its recorder).
Result<std::unique_ptr<Bag>> open_ros1_bag(const std::filesystem::path& file);

}  // namespace milepost::ros
