#include "mapper/aerial/block_plan.h"

#include <algorithm>
#include <optional>

namespace milepost {
namespace {

// Liang and Barsky's clipping: the part of the line within the box, as fractions of its length.
struct Inside {
  double from = 0;
  double to = 1;

  void limit(double start, double way, double low, double high) {
    if (way == 0) {
      if (start < low || start > high) to = -1;
      return;
    }
    const auto [enters, leaves] = std::minmax({(low - start) / way, (high - start) / way});
    from = std::max(from, enters);
    to = std::min(to, leaves);
  }
};

std::optional<WallLine> clipped(const WallLine& line, const GroundBox& box) {
  const Eigen::Vector2d way = line.end_m - line.begin_m;
  Inside inside;
  inside.limit(line.begin_m.x(), way.x(), box.west_m, box.east_m);
  inside.limit(line.begin_m.y(), way.y(), box.south_m, box.north_m);
  if (inside.from >= inside.to) return std::nullopt;
  return WallLine{line.begin_m + inside.from * way, line.begin_m + inside.to * way};
}

}  // namespace

std::vector<Block> blocks_of(const cv::Size& image, int core_px, int margin_px) {
  const cv::Rect all({0, 0}, image);
  std::vector<Block> blocks;
  for (int y = 0; y < image.height; y += core_px) {
    for (int x = 0; x < image.width; x += core_px) {
      const cv::Rect core = cv::Rect(x, y, core_px, core_px) & all;
      const cv::Rect seen = cv::Rect(core.x - margin_px, core.y - margin_px,
                                     core.width + 2 * margin_px, core.height + 2 * margin_px);
      blocks.push_back({core, seen & all});
    }
  }
  return blocks;
}

WallLines clipped(const WallLines& lines, const GroundBox& box) {
  WallLines inside;
  for (const WallLine& line : lines) {
    if (const std::optional<WallLine> part = clipped(line, box)) inside.push_back(*part);
  }
  return inside;
}

}  // namespace milepost
