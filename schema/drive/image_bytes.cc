#include "schema/drive/image_bytes.h"

#include <string_view>

namespace milepost {
namespace {

constexpr std::string_view kPngSignature("\x89PNG\r\n\x1a\n", 8);
constexpr std::string_view kJpegStart("\xff\xd8\xff", 3);

std::size_t big_endian(ByteView bytes) {
  std::size_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

// PNG (ISO 15948, 5.3): chunks of length, type, data and checksum; the last is IEND.
bool has_png_end(ByteView png) {
  ByteView rest = png.subspan(kPngSignature.size());
  while (rest.size() >= 12) {
    const std::size_t length = big_endian(rest.first(4));
    if (length > rest.size() - 12) return false;
    if (as_text(rest.subspan(4, 4)) == "IEND") return true;
    rest = rest.subspan(12 + length);
  }
  return false;
}

// JPEG (ITU T.81, B.1.1): marker segments with a length, and after a scan's header coded data in
// which 0xff is followed by 0 or a restart marker. A thumbnail's own end marker lies inside a
// segment, so segments are skipped whole.
bool has_jpeg_end(ByteView jpeg) {
  constexpr std::uint8_t kEndOfImage = 0xd9;
  std::size_t at = 2;
  while (at + 1 < jpeg.size()) {
    const std::uint8_t marker = jpeg[at + 1];
    const bool is_marker = jpeg[at] == 0xff && marker != 0 && marker != 0xff;
    const bool is_restart = marker >= 0xd0 && marker <= 0xd7;
    if (!is_marker) {
      at += 1;  // coded data or padding
    } else if (marker == kEndOfImage) {
      return true;
    } else if (is_restart) {
      at += 2;
    } else {
      if (at + 3 >= jpeg.size()) return false;
      at += 2 + big_endian(jpeg.subspan(at + 2, 2));
    }
  }
  return false;
}

}  // namespace

bool is_cut_short(ByteView image) {
  const std::string_view text = as_text(image);
  if (text.starts_with(kPngSignature)) return !has_png_end(image);
  if (text.starts_with(kJpegStart)) return !has_jpeg_end(image);
  return false;
}

}  // namespace milepost
