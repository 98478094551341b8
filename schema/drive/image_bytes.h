// Whether an encoded image is whole, judged by its data and not by its end marker. Decoders fill in
// what is missing, or write on standard error by themselves; a drive's reader wants neither.
#pragma once

#include <string>

#include "schema/base/result.h"

namespace milepost {

// The bytes of an image whose pixels can all be decoded, without a warning of the decoder: those
// given or, where a flaw costs no pixel (no end marker, padding before it, a damaged remark), the
// same pixels without the flaw. Bytes after the image's end do not matter. Any other format than
// JPEG and PNG is given back as it is: its decoder has to tell. Safe from several threads.
// Errors (`what` begins with a verb, `where` is left to the caller): invalid_input for an image
// that is cut short, damaged or cannot be decoded.
Result<std::string> sound_image(std::string bytes);

// The same for one format. REQUIRES: `bytes` begin as this format does.
Result<std::string> sound_jpeg(std::string bytes);
Result<std::string> sound_png(std::string bytes);

// What sound_image says of the images that it does not take.
inline Error cut_short() {
  return {ErrorCode::invalid_input, "", "is cut short", "copy the image again"};
}
inline Error damaged() {
  return {ErrorCode::invalid_input, "", "is damaged", "copy the image again"};
}
inline Error not_decodable() {
  return {ErrorCode::invalid_input, "", "cannot be decoded", "replace the image"};
}

inline constexpr std::string_view kJpegStart("\xff\xd8\xff", 3);
inline constexpr std::string_view kPngSignature("\x89PNG\r\n\x1a\n", 8);

}  // namespace milepost
