// PNG (ISO 15948): checks that every row of the image is present, with the library that decodes it
// later.
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <memory>
#include <string_view>
#include <vector>

#include "schema/drive/image_bytes.h"

namespace milepost {
namespace {

constexpr std::size_t kChunkFrame = 12;  // length, type and checksum around a chunk's data
constexpr std::string_view kEnd("\0\0\0\0IEND\xae\x42\x60\x82", 12);

// The chunks that pixels depend on, and the EXIF data, which holds the orientation.
constexpr std::string_view kKeptChunks[] = {"IHDR", "PLTE", "tRNS", "IDAT", "eXIf"};

enum class PngVerdict { whole, flawed, cut_short, damaged };

struct Reading {
  std::string_view rest;
  bool ran_out = false;
  bool has_rows = false;
  bool flawed = false;
  png_structp image = nullptr;
  png_infop info = nullptr;
  std::vector<png_byte> row;

  ~Reading() { png_destroy_read_struct(&image, &info, nullptr); }
};

Reading& reading_of(png_structp image) { return *static_cast<Reading*>(png_get_error_ptr(image)); }

void note_warning(png_structp image, png_const_charp /*text*/) { reading_of(image).flawed = true; }

[[noreturn]] void end_png_with_error(png_structp image, png_const_charp /*text*/) {
  png_longjmp(image, 1);
}

void take_bytes(png_structp image, png_bytep to, std::size_t count) {
  Reading& reading = reading_of(image);
  if (count > reading.rest.size()) {
    reading.ran_out = true;
    png_error(image, "");
  }
  std::memcpy(to, reading.rest.data(), count);
  reading.rest.remove_prefix(count);
}

// No local has a destructor: the library leaves by longjmp.
PngVerdict read_png(Reading& reading) {
  png_structp image = reading.image;
  if (setjmp(png_jmpbuf(image)) != 0) {  // NOLINT(cert-err52-cpp): a C library
    if (reading.has_rows) return PngVerdict::flawed;
    return reading.ran_out ? PngVerdict::cut_short : PngVerdict::damaged;
  }
  png_read_info(image, reading.info);
  const int passes = png_set_interlace_handling(image);
  png_read_update_info(image, reading.info);
  reading.row.resize(png_get_rowbytes(image, reading.info));
  const png_uint_32 rows = png_get_image_height(image, reading.info);
  for (int pass = 0; pass < passes; ++pass) {
    for (png_uint_32 i = 0; i < rows; ++i) png_read_row(image, reading.row.data(), nullptr);
  }
  reading.has_rows = true;
  png_read_end(image, nullptr);
  return reading.flawed ? PngVerdict::flawed : PngVerdict::whole;
}

std::size_t big_endian(std::string_view bytes) {
  std::size_t value = 0;
  for (const char byte : bytes) value = value << 8U | static_cast<unsigned char>(byte);
  return value;
}

// The image without metadata chunks, and with its end chunk. Empty if its data is not in complete
// chunks.
std::string cleaned(std::string_view png) {
  std::string clean(kPngSignature);
  std::string_view rest = png.substr(kPngSignature.size());
  while (rest.size() >= kChunkFrame) {
    const std::size_t length = big_endian(rest.substr(0, 4));
    const std::string_view type = rest.substr(4, 4);
    if (length > rest.size() - kChunkFrame) return type == "IDAT" ? "" : clean.append(kEnd);
    if (type == "IEND") break;
    if (std::ranges::count(kKeptChunks, type) > 0) clean += rest.substr(0, length + kChunkFrame);
    rest.remove_prefix(length + kChunkFrame);
  }
  return clean.append(kEnd);
}

PngVerdict png_verdict_of(std::string_view png) {
  const auto reading = std::make_unique<Reading>();
  reading->rest = png;
  reading->image = png_create_read_struct(PNG_LIBPNG_VER_STRING, reading.get(), end_png_with_error,
                                          note_warning);
  reading->info = png_create_info_struct(reading->image);
  png_set_read_fn(reading->image, nullptr, take_bytes);
  return read_png(*reading);
}

}  // namespace

Result<std::string> sound_png(std::string bytes) {
  switch (png_verdict_of(bytes)) {
    case PngVerdict::whole:
      return bytes;
    case PngVerdict::flawed:
      break;
    case PngVerdict::cut_short:
      return cut_short();
    case PngVerdict::damaged:
      return damaged();
  }
  std::string clean = cleaned(bytes);
  if (clean.empty()) return cut_short();
  if (png_verdict_of(clean) != PngVerdict::whole) return damaged();
  return clean;
}

}  // namespace milepost
