// Splits a large image into blocks.
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "mapper/aerial/orthoimage.h"
#include "mapper/aerial/wall_line.h"

namespace milepost {

struct Block {
  cv::Rect core;  // in pixels of the image; the cores partition it
  cv::Rect seen;  // the core and a margin around it, within the image
};

// Row by row from the top left. REQUIRES: `core_px` > 0, `margin_px` >= 0.
std::vector<Block> blocks_of(const cv::Size& image, int core_px, int margin_px);

// A rectangle of the ground.
struct GroundBox {
  double west_m = 0, south_m = 0, east_m = 0, north_m = 0;
};

// Clips each line to the box; lines outside are dropped.
WallLines clipped(const WallLines& lines, const GroundBox& box);

}  // namespace milepost
