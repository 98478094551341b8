#include "schema/drive/frame_image.h"

#include <string>
#include <utility>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "schema/base/file.h"
#include "schema/drive/grey_depth.h"
#include "schema/drive/image_decode.h"
#include "schema/drive/tables.h"

namespace milepost {
namespace {

std::string place_of(const Drive& drive, std::size_t frame_index) {
  const std::string file = (drive.folder / kTrajectoryFile).string();
  const std::size_t line = drive.frames[frame_index].line;
  if (line > 0) return file + ", line " + std::to_string(line);
  return file + ", frame " + std::to_string(frame_index);
}

std::vector<std::filesystem::path> images_of(const Drive& drive) {
  std::vector<std::filesystem::path> images;
  images.reserve(drive.frames.size());
  for (const Frame& frame : drive.frames) images.push_back(drive.frame_path(frame));
  return images;
}

std::string size_text(int width_px, int height_px) {
  return std::to_string(width_px) + "x" + std::to_string(height_px);
}

// The image as 8-bit grey. Errors: `where` is left to the caller.
Result<cv::Mat> whole_image(const std::string& image, int grey_bits) {
  Result<std::string> bytes = read_text_file(image);
  if (!bytes) {
    return Error{bytes.error().code, "", "image " + image + ": " + bytes.error().what,
                 "restore the image"};
  }
  Result<cv::Mat> gray =
      decoded_image(std::move(*bytes), cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH);
  if (!gray) {
    const Error& error = gray.error();
    return Error{error.code, "", "image " + image + " " + error.what, error.hint};
  }
  if (gray->type() == CV_8UC1) return gray;
  if (gray->type() == CV_16UC1) return in_8_bits(*gray, grey_bits);
  return Error{ErrorCode::invalid_input, "",
               "image " + image + " has grey values that are not whole numbers of 8 or 16 bits",
               "convert the image"};
}

// Whether an image would have the camera's size if its EXIF orientation had not turned it.
bool was_turned(const cv::Mat& gray, const std::string& image, const Camera& camera) {
  if (gray.cols != camera.height_px || gray.rows != camera.width_px) return false;
  Result<std::string> bytes = read_text_file(image);
  if (!bytes) return false;
  const auto stored =
      decoded_image(std::move(*bytes), cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
  return stored && stored->cols == camera.width_px;
}

Status check_size(const cv::Mat& gray, const std::string& image, const Camera& camera) {
  if (gray.cols == camera.width_px && gray.rows == camera.height_px) return ok_status();
  if (was_turned(gray, image, camera)) {
    return Error{ErrorCode::invalid_input, "",
                 "image " + image + " is " + size_text(gray.cols, gray.rows) +
                     " pixels once its EXIF orientation is applied, the camera's images " +
                     size_text(camera.width_px, camera.height_px),
                 "describe the camera of the images as they are shown, or remove the orientation "
                 "from the images"};
  }
  return Error{ErrorCode::invalid_input, "",
               "image " + image + " is " + size_text(gray.cols, gray.rows) +
                   " pixels, the camera's images " + size_text(camera.width_px, camera.height_px),
               "correct the camera's size in drive.json or the image"};
}

}  // namespace

FrameReader::FrameReader(const Drive& drive)
    : drive_(drive), grey_bits_(grey_bits_of(images_of(drive))) {}

Result<cv::Mat> FrameReader::gray(std::size_t frame_index) const {
  const std::string place = place_of(drive_, frame_index);
  const std::string image = drive_.frame_path(drive_.frames[frame_index]).string();
  const auto at_place = [&](Error error, const std::string& other_mend) {
    error.where = place;
    error.hint += other_mend;
    return error;
  };
  Result<cv::Mat> gray = whole_image(image, grey_bits_);
  if (!gray) return at_place(gray.error(), " or remove the row");
  const Status size = check_size(*gray, image, drive_.camera);
  return size ? gray : at_place(size.error(), "");
}

Result<cv::Mat> read_image_gray(const std::filesystem::path& image, const Camera& camera,
                                int grey_bits) {
  Result<cv::Mat> gray = whole_image(image.string(), grey_bits);
  if (!gray) return gray;
  const Status size = check_size(*gray, image.string(), camera);
  return size ? gray : size.error();
}

}  // namespace milepost
