// Checks that an encoded image is complete, by its data and not by its end marker. Decoders fill in
// missing data or write to standard error; a drive's reader wants neither.
#pragma once

#include <string>

#include "schema/base/result.h"

namespace milepost {

// Returns bytes of the image of which the decoder decodes all pixels without a warning: those given
// or, where a defect affects no pixel (no end marker, padding before it, damaged metadata), the
// same pixels without the defect. Bytes after the image's end are ignored. Formats other than JPEG
// and PNG are returned unchanged: their decoder reports errors. Safe from several threads.
// Errors (`what` begins with a verb, `where` is left to the caller): invalid_input for an image
// that is truncated, damaged, CMYK or cannot be decoded.
Result<std::string> sound_image(std::string bytes);

// The same for one format. REQUIRES: `bytes` begin with the signature of this format.
Result<std::string> sound_jpeg(std::string bytes);
Result<std::string> sound_png(std::string bytes);

// The errors of sound_image.
inline Error cut_short() {
  return {ErrorCode::invalid_input, "", "is truncated", "copy the image again"};
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
