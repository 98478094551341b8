// A bag of ROS 2 in SQLite: a .db3 file, or a folder of them.
#pragma once

#include <filesystem>
#include <memory>

#include "mapper/import/ros/bag.h"
#include "schema/base/result.h"

namespace milepost::ros {

// Opens a file, or all files of a folder. Messages that are compressed on their own are read, too.
// Errors: not_found, io, corrupt; invalid_input (no such bag, compressed or stored in a way that is
// not read, not closed by its recorder).
Result<std::unique_ptr<Bag>> open_ros2_bag(const std::filesystem::path& file_or_folder);

}  // namespace milepost::ros
