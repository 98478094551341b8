#include "schema/drive/grey_depth.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include <opencv2/imgcodecs.hpp>

#include "schema/base/file.h"
#include "schema/drive/image_bytes.h"
#include "schema/drive/image_decode.h"

namespace milepost {
namespace {

constexpr std::size_t kMostSampled = 16;
constexpr int kDepths[] = {8, 10, 12, 14, 16};  // of cameras' A/D converters

std::uint32_t number_in(std::string_view bytes, bool little_endian) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const char byte = bytes[little_endian ? bytes.size() - 1 - i : i];
    value = value << 8U | static_cast<unsigned char>(byte);
  }
  return value;
}

// PNG (ISO 15948): the depth is in the header; sBIT has a byte for each channel.
std::optional<int> bits_declared_by_png(std::string_view png) {
  constexpr std::size_t kHeaderEnd = 33;
  constexpr std::size_t kDepthAt = 24;
  if (png.size() < kHeaderEnd || png[kDepthAt] != 16) return std::nullopt;
  std::string_view rest = png.substr(kHeaderEnd);
  while (rest.size() >= 12) {
    const std::size_t length = number_in(rest.substr(0, 4), false);
    const std::string_view type = rest.substr(4, 4);
    if (type == "IDAT" || length > rest.size() - 12) break;
    if (type == "sBIT" && length > 0) return static_cast<unsigned char>(rest[8]);
    rest.remove_prefix(length + 12);
  }
  return 0;
}

// The next number of a PNM's header, past white space and comments.
std::uint32_t take_number(std::string_view& header) {
  while (!header.empty() && std::isdigit(static_cast<unsigned char>(header.front())) == 0) {
    const bool is_comment = header.front() == '#';
    header.remove_prefix(is_comment ? std::min(header.find('\n'), header.size() - 1) + 1 : 1);
  }
  std::uint32_t value = 0;
  while (!header.empty() && std::isdigit(static_cast<unsigned char>(header.front())) != 0) {
    value = std::min(value * 10 + static_cast<std::uint32_t>(header.front() - '0'), 1000000U);
    header.remove_prefix(1);
  }
  return value;
}

// PGM and PPM: P2, P3, P5 or P6, then width, height and the greatest value.
std::optional<int> bits_declared_by_pnm(std::string_view pnm) {
  pnm.remove_prefix(2);
  take_number(pnm);
  take_number(pnm);
  const std::uint32_t greatest = take_number(pnm);
  if (greatest <= std::numeric_limits<std::uint8_t>::max()) return std::nullopt;
  return static_cast<int>(std::bit_width(greatest));
}

// TIFF 6.0: the directory's entries are of 12 bytes: tag, type, count, value.
std::optional<int> bits_declared_by_tiff(std::string_view tiff) {
  constexpr std::uint32_t kMaxSampleValue = 281;
  constexpr std::size_t kEntry = 12;
  const bool little_endian = tiff.starts_with("II");
  const std::size_t directory = number_in(tiff.substr(4, 4), little_endian);
  if (directory + 2 > tiff.size()) return 0;
  const std::size_t count = number_in(tiff.substr(directory, 2), little_endian);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = directory + 2 + i * kEntry;
    if (at + kEntry > tiff.size()) break;
    const std::string_view entry = tiff.substr(at, kEntry);
    if (number_in(entry.substr(0, 2), little_endian) != kMaxSampleValue) continue;
    if (number_in(entry.substr(4, 4), little_endian) != 1) break;  // not one channel
    return static_cast<int>(std::bit_width(number_in(entry.substr(8, 2), little_endian)));
  }
  return 0;
}

// The bit depth that the image declares: none for values of 8 bits, 0 if it declares nothing.
std::optional<int> declared_bits(std::string_view image) {
  if (image.starts_with(kJpegStart)) return std::nullopt;
  if (image.starts_with(kPngSignature)) return bits_declared_by_png(image);
  if (image.starts_with(std::string_view("II*\0", 4)) ||
      image.starts_with(std::string_view("MM\0*", 4))) {
    return bits_declared_by_tiff(image);
  }
  if (image.size() > 2 && image[0] == 'P' && image[1] >= '2' && image[1] <= '6') {
    return bits_declared_by_pnm(image);
  }
  return 0;
}

// The bit depth that one image requires: 0 if it cannot be told.
int bits_of(const std::filesystem::path& file) {
  Result<std::string> bytes = read_text_file(file);
  if (!bytes) return 0;
  const std::optional<int> declared = declared_bits(*bytes);
  if (!declared) return 0;
  const Result<cv::Mat> gray =
      decoded_image(std::move(*bytes), cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH);
  if (!gray || gray->type() != CV_16UC1) return 0;
  double greatest = 0;
  cv::minMaxLoc(*gray, nullptr, &greatest);
  // Writers that do not know the depth also declare 16 bits.
  return std::max(*declared < 16 ? *declared : 0,
                  static_cast<int>(std::bit_width(static_cast<unsigned>(greatest))));
}

}  // namespace

int grey_bits_of(const std::vector<std::filesystem::path>& images) {
  const std::size_t sampled = std::min(images.size(), kMostSampled);
  int needed = 0;
  for (std::size_t i = 0; i < sampled; ++i) {
    const std::size_t at = sampled < 2 ? 0 : i * (images.size() - 1) / (sampled - 1);
    needed = std::max(needed, bits_of(images[at]));
  }
  const int* const depth = std::ranges::find_if(kDepths, [&](int bits) { return bits >= needed; });
  return depth == std::end(kDepths) ? kDepths[std::size(kDepths) - 1] : *depth;
}

cv::Mat in_8_bits(const cv::Mat& gray, int bits) {
  cv::Mat eight(gray.size(), CV_8UC1);
  for (int row = 0; row < gray.rows; ++row) {
    const auto* const from = gray.ptr<std::uint16_t>(row);
    std::transform(from, from + gray.cols, eight.ptr<std::uint8_t>(row), [bits](unsigned value) {
      return static_cast<std::uint8_t>(std::min(value >> (bits - 8U), 255U));
    });
  }
  return eight;
}

}  // namespace milepost
