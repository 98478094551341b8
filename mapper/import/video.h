// The frames of a video as images, by FFmpeg's libraries.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "mapper/import/recording.h"
#include "schema/base/result.h"

namespace milepost {

struct Video {
  std::vector<RecordedImage> images;  // in the order of their times
  std::shared_ptr<ImageContainer> frames;
};

// Times count from the video's creation, if it tells it, else from its begin. At most `rate_hz`
// images a second are taken; 0: all. They are turned as a player would turn them, and written as
// JPEG. Errors: not_found, invalid_input (no video).
Result<Video> open_video(const std::filesystem::path& file, double rate_hz);

}  // namespace milepost
