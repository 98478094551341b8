// The images of a drive's frames, decoded.
#pragma once

#include <filesystem>
#include <vector>

#include <opencv2/core.hpp>

#include "schema/base/result.h"
#include "schema/drive/drive.h"

namespace milepost {

// Reads the frames of one drive as 8-bit grey. Immutable, so safe to share between threads.
class FrameReader {
 public:
  // Samples some frames for the bit depth of the drive's grey values (grey_bits_of), by which all
  // frames are scaled to 8 bits. REQUIRES: `drive` outlives the reader.
  explicit FrameReader(const Drive& drive);

  // The frame's image as 8-bit grey, one channel, of the camera's size. An EXIF orientation is
  // applied first: the drive's camera describes the upright image.
  // REQUIRES: frame_index < drive.frames.size().
  // Errors (each names the line of trajectory.csv and the image): not_found, io; invalid_input for
  // an image that is truncated, damaged, cannot be decoded, has other values than whole numbers of
  // up to 16 bits, or another size than the camera's.
  Result<cv::Mat> gray(std::size_t frame_index) const;

 private:
  const Drive& drive_;
  int grey_bits_;
};

// An image outside any drive, the same way; `grey_bits` are those of the images that it belongs to.
// Safe from several threads. Errors (each names the image): those of FrameReader::gray.
Result<cv::Mat> read_image_gray(const std::filesystem::path& image, const Camera& camera,
                                int grey_bits);

}  // namespace milepost
