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

// A view of pixels that the caller owns; they are read only during the call that receives the view.
// Rows from top to bottom, pixels from left to right. Apply the orientation that the camera driver
// reports (EXIF, say) beforehand: the camera parameters describe the upright image.
struct ImageView {
  const std::uint8_t* data = nullptr;
  int width_px = 0;
  int height_px = 0;
  std::ptrdiff_t stride_bytes = 0;  // from the start of one row to that of the next
  PixelFormat format = PixelFormat::gray8;
};

}  // namespace milepost::vehicle
