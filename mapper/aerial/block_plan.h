// How a large image is cut into blocks.
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "mapper/aerial/orthoimage.h"
#include "mapper/aerial/wall_line.h"

namespace milepost {

struct Block {
  cv::Rect core;  // in pixels of the image; the cores cover it once
  cv::Rect seen;  // the core and a margin about it, within the image
};

// Row by row from the top left. REQUIRES: `core_px` > 0, `margin_px` >= 0.
std::vector<Block> blocks_of(const cv::Size& image, int core_px, int margin_px);

// A rectangle of the ground.
struct GroundBox {
  double west_m = 0, south_m = 0, east_m = 0, north_m = 0;
};

// The part of each line that lies in the box; lines of which none does are left out.
WallLines clipped(const WallLines& lines, const GroundBox& box);

}  // namespace milepost
