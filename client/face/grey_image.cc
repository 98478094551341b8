#include "client/face/grey_image.h"

#include <string>

#include <opencv2/imgproc.hpp>

namespace milepost::vehicle {
namespace {

struct Layout {
  int channels = 1;
  int to_grey = -1;  // OpenCV's conversion code; -1: already grey
};

Layout layout_of(PixelFormat format) {
  switch (format) {
    case PixelFormat::rgb8:
      return {3, cv::COLOR_RGB2GRAY};
    case PixelFormat::bgr8:
      return {3, cv::COLOR_BGR2GRAY};
    case PixelFormat::rgba8:
      return {4, cv::COLOR_RGBA2GRAY};
    case PixelFormat::bgra8:
      return {4, cv::COLOR_BGRA2GRAY};
    case PixelFormat::gray8:
      break;
  }
  return {};
}

std::string size_of(int width_px, int height_px) {
  return std::to_string(width_px) + "x" + std::to_string(height_px);
}

}  // namespace

Result<cv::Mat> grey_image(const ImageView& image, const Camera& camera) {
  if (image.data == nullptr) {
    return Error{ErrorCode::invalid_input, "image", "it has no data",
                 "pass a pointer to its first pixel"};
  }
  if (image.width_px != camera.width_px || image.height_px != camera.height_px) {
    return Error{ErrorCode::invalid_input, "image",
                 "it has " + size_of(image.width_px, image.height_px) + " pixels, the camera " +
                     size_of(camera.width_px, camera.height_px),
                 "pass images of the size in the camera parameters"};
  }
  const Layout layout = layout_of(image.format);
  if (image.stride_bytes < static_cast<std::ptrdiff_t>(image.width_px) * layout.channels) {
    return Error{ErrorCode::invalid_input, "image", "stride_bytes is shorter than a row",
                 "pass the bytes from the start of one row to that of the next"};
  }
  // OpenCV has no views of constant data; it only reads this one.
  const cv::Mat pixels(image.height_px, image.width_px, CV_8UC(layout.channels),
                       const_cast<std::uint8_t*>(  // NOLINT(cppcoreguidelines-pro-type-const-cast)
                           image.data),
                       static_cast<std::size_t>(image.stride_bytes));
  if (layout.to_grey < 0) return pixels;
  cv::Mat grey;
  cv::cvtColor(pixels, grey, layout.to_grey);
  return grey;
}

}  // namespace milepost::vehicle
