#include "mapper/import/ros/image_files.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace milepost::ros {
namespace {

constexpr int kAsItIs = -1;
struct Encoding {
  std::string_view name;
  int type;        // of cv::Mat
  int conversion;  // cv::ColorConversionCodes to grey or BGR, or kAsItIs
};

constexpr std::array<Encoding, 17> kEncodings = {{
    {"mono8", CV_8UC1, kAsItIs},
    {"8UC1", CV_8UC1, kAsItIs},
    {"mono16", CV_16UC1, kAsItIs},
    {"16UC1", CV_16UC1, kAsItIs},
    {"bgr8", CV_8UC3, kAsItIs},
    {"8UC3", CV_8UC3, kAsItIs},
    {"rgb8", CV_8UC3, cv::COLOR_RGB2BGR},
    {"bgra8", CV_8UC4, cv::COLOR_BGRA2BGR},
    {"rgba8", CV_8UC4, cv::COLOR_RGBA2BGR},
    {"bayer_rggb8", CV_8UC1, cv::COLOR_BayerRGGB2BGR},
    {"bayer_bggr8", CV_8UC1, cv::COLOR_BayerBGGR2BGR},
    {"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGBRG2BGR},
    {"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGRBG2BGR},
    {"bayer_rggb16", CV_16UC1, cv::COLOR_BayerRGGB2BGR},
    {"bayer_bggr16", CV_16UC1, cv::COLOR_BayerBGGR2BGR},
    {"bayer_gbrg16", CV_16UC1, cv::COLOR_BayerGBRG2BGR},
    {"bayer_grbg16", CV_16UC1, cv::COLOR_BayerGRBG2BGR},
}};

const Encoding* encoding_of(const Image& image) {
  const auto found = std::ranges::find(kEncodings, image.encoding, &Encoding::name);
  return found == kEncodings.end() ? nullptr : found;
}

}  // namespace

Status check_image(const Image& image) {
  const Encoding* const encoding = encoding_of(image);
  if (encoding == nullptr) {
    return Error{
        ErrorCode::invalid_input, "",
        "has the encoding '" + std::string(image.encoding.substr(0, 40)) + "', which is not read",
        "convert the topic to mono8, mono16, rgb8, bgr8, rgba8, bgra8 or bayer_*"};
  }
  const std::uint64_t row_bytes = std::uint64_t{image.width_px} * CV_ELEM_SIZE(encoding->type);
  const bool has_size = image.width_px > 0 && image.height_px > 0 && image.width_px <= kMaxSidePx &&
                        image.height_px <= kMaxSidePx;
  if (has_size && image.row_bytes >= row_bytes &&
      image.pixels.size() >= std::uint64_t{image.row_bytes} * (image.height_px - 1) + row_bytes)
    return ok_status();
  return Error{ErrorCode::corrupt, "",
               "has " + std::to_string(image.pixels.size()) + " bytes of pixels in rows of " +
                   std::to_string(image.row_bytes) + ", not " + std::to_string(image.width_px) +
                   " x " + std::to_string(image.height_px) + " of " + std::string(encoding->name),
               "record the topic again"};
}

Result<Bytes> png_of(const Image& image) {
  if (const Status checked = check_image(image); !checked) return checked.error();
  const Encoding& encoding = *encoding_of(image);
  cv::Mat pixels(static_cast<int>(image.height_px), static_cast<int>(image.width_px),
                 encoding.type);
  const std::size_t row_bytes = pixels.cols * pixels.elemSize();
  for (int row = 0; row < pixels.rows; ++row)
    std::memcpy(pixels.ptr(row), image.pixels.data() + std::size_t{image.row_bytes} * row,
                row_bytes);
  constexpr bool kIsBigEndian = std::endian::native == std::endian::big;
  if (pixels.depth() == CV_16U && image.is_big_endian != kIsBigEndian) {
    pixels.forEach<std::uint16_t>([](std::uint16_t& value, const int*) {
      value = static_cast<std::uint16_t>(value << 8U | value >> 8U);
    });
  }
  // Smaller ones have no pattern to take the colours from.
  const bool is_bayer = encoding.conversion != kAsItIs && pixels.channels() == 1;
  if (encoding.conversion != kAsItIs && (!is_bayer || std::min(pixels.rows, pixels.cols) > 2))
    cv::cvtColor(pixels, pixels, encoding.conversion);
  Bytes file;
  cv::imencode(".png", pixels, file);
  return file;
}

Result<std::string> ending_of(const CompressedImage& image) {
  struct Signature {
    std::string_view begins;
    const char* ending;
  };
  static constexpr std::array<Signature, 4> kSignatures = {
      {{std::string_view("\xff\xd8\xff", 3), ".jpg"},
       {std::string_view("\x89PNG\r\n\x1a\n", 8), ".png"},
       {std::string_view("II*\0", 4), ".tif"},
       {std::string_view("MM\0*", 4), ".tif"}}};
  const std::string_view file = as_text(image.file);
  for (const Signature& signature : kSignatures)
    if (file.starts_with(signature.begins)) return std::string(signature.ending);
  if (file.starts_with("RIFF") && file.substr(0, 12).ends_with("WEBP")) return std::string(".webp");
  return Error{ErrorCode::invalid_input, "",
               "has the format '" + std::string(image.format.substr(0, 40)) +
                   "', whose bytes are no JPEG, PNG, TIFF or WebP",
               "record or convert the topic with the transport 'compressed'"};
}

}  // namespace milepost::ros
