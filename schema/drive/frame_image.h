// The images of a drive's frames, decoded.
#pragma once

#include <filesystem>

#include <opencv2/core.hpp>

#include "schema/base/result.h"
#include "schema/drive/drive.h"

namespace milepost {

// The frame's image as 8-bit grey, one channel, of the camera's size. An EXIF orientation is
// applied first: the drive's camera describes the upright image. Safe from several threads.
// REQUIRES: frame_index < drive.frames.size().
// Errors (each names the line of trajectory.csv and the image): not_found, io; invalid_input for
// an image that is cut short, cannot be decoded or has another size than the camera's.
Result<cv::Mat> read_frame_gray(const Drive& drive, std::size_t frame_index);

// An image outside any drive, the same way. Safe from several threads.
// Errors (each names the image): those of read_frame_gray.
Result<cv::Mat> read_image_gray(const std::filesystem::path& image, const Camera& camera);

}  // namespace milepost
