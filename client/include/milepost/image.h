// One image of the vehicle's camera.
#pragma once

#include <cstddef>
#include <cstdint>

namespace milepost::vehicle {

enum class PixelFormat {
  gray8,
  rgb8,
  bgr8,
  rgba8,
  bgra8,
};

// Somebody else's pixels, read during the call that is given them and not kept. Rows from the top,
// pixels from the left. What a camera's driver says of an image's orientation is applied first: the
// camera's parameters describe the upright image.
struct ImageView {
  const std::uint8_t* data = nullptr;
  int width_px = 0;
  int height_px = 0;
  std::ptrdiff_t stride_bytes = 0;  // from a row to the next
  PixelFormat format = PixelFormat::gray8;
};

}  // namespace milepost::vehicle
