// Cameras and images of a model as COLMAP stores it, as text or binary.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "schema/base/result.h"
#include "schema/geo/camera.h"

namespace milepost {

struct ColmapImage {
  std::string name;  // with its folder, below that of the images
  std::uint32_t camera = 0;
  Eigen::Isometry3d world_from_camera;
};

struct ColmapModel {
  std::map<std::uint32_t, Camera> cameras;  // by id, without a mounting
  std::vector<ColmapImage> images;
};

// A folder with cameras.bin and images.bin, or cameras.txt and images.txt. Errors: not_found, io;
// invalid_input, also for a camera model that this project has no lens for.
Result<ColmapModel> read_colmap_model(const std::filesystem::path& folder);

}  // namespace milepost
