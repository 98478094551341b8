// Images of messages as image files.
#pragma once

#include <string>

#include "mapper/import/ros/messages.h"
#include "schema/base/bytes.h"
#include "schema/base/result.h"

namespace milepost::ros {

// Checks what an image's message tells of it, not its pixels. Errors: invalid_input (an encoding
// that is not read, by its name), corrupt (pixels are missing); `where` is left to the caller.
Status check_image(const Image& image);

// The image as PNG: grey as it is, colours and Bayer patterns as colours, without alpha. Errors: as
// above.
Result<Bytes> png_of(const Image& image);

// The ending of the file in a compressed image, with its dot, by its first bytes: .jpg, .png, .tif,
// .webp. Errors: invalid_input; `where` is left to the caller.
Result<std::string> ending_of(const CompressedImage& image);

}  // namespace milepost::ros
