#include "tests/schema/tile/example_tile.h"

#include <cstdio>

namespace milepost::testing {
namespace {

Tracklet tracklet(int number) {
  Tracklet t;
  for (int i = 0; i < kDescriptorBytes; ++i) {
    t.descriptor[i] = static_cast<std::uint8_t>(7 * i + 50 * number);
  }
  t.offset_m = 98765.4375 + 143.71875 * number;
  t.slope = 250.3125 + number;
  t.scale_min_px = 2.1F + static_cast<float>(number);
  t.scale_max_px = 9.7F + static_cast<float>(number);
  t.along = {98765.4375 - 3.25 * number, 98789.0625 + number};
  t.pixels = {0, 1240, static_cast<float>(10 * number), 375};
  t.r_squared = 0.83F + 0.05F * static_cast<float>(number);
  t.residual_sigma_m = 0.041F;
  t.observations = static_cast<std::uint16_t>(3 + 400 * number);
  return t;
}

}  // namespace

TrackletTile example_tile() {
  return {"kitti-00", 3951, ScaleModel::inverse_scale, {tracklet(0), tracklet(1), tracklet(2)}};
}

std::string text_of(const TrackletTile& tile) {
  std::string text = tile.segment + " " + std::to_string(tile.index) + " " +
                     std::to_string(static_cast<int>(tile.model)) + "\n";
  for (const Tracklet& t : tile.tracklets) {
    char line[512];
    std::snprintf(line, sizeof line,
                  "%.17g %.9g %.9g %.9g %.17g %.17g %.0f %.0f %.0f %.0f %.9g %.9g %d ", t.offset_m,
                  t.slope, t.scale_min_px, t.scale_max_px, t.along.from_m, t.along.to_m,
                  t.pixels.x_min_px, t.pixels.x_max_px, t.pixels.y_min_px, t.pixels.y_max_px,
                  t.r_squared, t.residual_sigma_m, t.observations);
    text += line;
    for (const std::uint8_t byte : t.descriptor) {
      std::snprintf(line, sizeof line, "%02x", byte);
      text += line;
    }
    text += "\n";
  }
  return text;
}

}  // namespace milepost::testing
