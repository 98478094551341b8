#include "tests/schema/tile/example_landmarks.h"

#include <cstdio>

namespace milepost::testing {
namespace {

CompactDescriptor descriptor(int number) {
  CompactDescriptor values{};
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = static_cast<std::int8_t>(11 * static_cast<int>(k) + 70 * number - 128);
  }
  return values;
}

}  // namespace

LandmarkTile example_landmarks() {
  LandmarkTile tile{"kitti-00", 3951, 98765.4375, std::vector<Landmark>(3)};
  tile.landmarks[0] = {descriptor(0), {12.34, -5.67, 0.89},     0.31F, 0.52F,
                       0.048F,        {98765.4375, 98789.0375}, 3};
  tile.landmarks[1] = {
      descriptor(1), {-327.68, 327.67, -1.6}, 100, 99, 0, {98765.5375, 98765.5375}, 255};
  tile.landmarks[2] = {descriptor(2),
                       {-0.01, 2.56, 40.96},
                       0.0005F,
                       0.02F,
                       1,
                       {98790.4375, 98790.4375 + 6553.5},
                       17};
  return tile;
}

std::string text_of(const LandmarkTile& tile) {
  char line[512];
  std::snprintf(line, sizeof line, " %u %.17g\n", tile.index, tile.origin_m);
  std::string text = tile.segment + line;
  for (const Landmark& landmark : tile.landmarks) {
    std::snprintf(line, sizeof line, "%.2f %.2f %.2f %.6g %.6g %.3f %.4f %.4f %d ",
                  landmark.position.east_m, landmark.position.north_m, landmark.position.up_m,
                  landmark.depth_sigma_m, landmark.size_m, landmark.size_sigma,
                  landmark.along.from_m, landmark.along.to_m, landmark.observations);
    text += line;
    for (const std::int8_t value : landmark.descriptor) {
      std::snprintf(line, sizeof line, "%02x", static_cast<std::uint8_t>(value));
      text += line;
    }
    text += "\n";
  }
  return text;
}

}  // namespace milepost::testing
