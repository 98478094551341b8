#include "schema/drive/image_bytes.h"

#include <utility>

namespace milepost {

Result<std::string> sound_image(std::string bytes) {
  if (bytes.starts_with(kJpegStart)) return sound_jpeg(std::move(bytes));
  if (bytes.starts_with(kPngSignature)) return sound_png(std::move(bytes));
  return bytes;
}

}  // namespace milepost
