#include "schema/drive/frame_image.h"

#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "schema/base/file.h"
#include "schema/drive/image_bytes.h"
#include "schema/drive/tables.h"

namespace milepost {
namespace {

std::string place_of(const Drive& drive, std::size_t frame_index) {
  const std::string file = (drive.folder / kTrajectoryFile).string();
  const std::size_t line = drive.frames[frame_index].line;
  if (line > 0) return file + ", line " + std::to_string(line);
  return file + ", frame " + std::to_string(frame_index);
}

std::string size_text(int width_px, int height_px) {
  return std::to_string(width_px) + "x" + std::to_string(height_px);
}

// The decoded image, or an empty one.
cv::Mat decoded(const std::string& bytes) {
  if (bytes.empty()) return {};
  const std::vector<unsigned char> buffer(bytes.begin(), bytes.end());
  try {
    return cv::imdecode(buffer, cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {  // for example, more pixels than the decoder allows
    return {};
  }
}

// Errors say what is wrong with the image, whose name begins `what`; `where` is left to the caller.
Result<cv::Mat> whole_image(const std::string& image) {
  const Result<std::string> bytes = read_text_file(image);
  if (!bytes) {
    return Error{bytes.error().code, "", "image " + image + ": " + bytes.error().what,
                 "restore the image"};
  }
  if (is_cut_short(as_bytes(*bytes))) {
    return Error{ErrorCode::invalid_input, "", "image " + image + " is cut short",
                 "copy the image again"};
  }
  cv::Mat gray = decoded(*bytes);
  if (!gray.empty()) return gray;
  return Error{ErrorCode::invalid_input, "", "image " + image + " cannot be decoded",
               "replace the image"};
}

Status check_size(const cv::Mat& gray, const std::string& image, const Camera& camera) {
  if (gray.cols == camera.width_px && gray.rows == camera.height_px) return ok_status();
  return Error{ErrorCode::invalid_input, "",
               "image " + image + " is " + size_text(gray.cols, gray.rows) +
                   " pixels, the camera's images " + size_text(camera.width_px, camera.height_px),
               "correct the camera's size in drive.json or the image"};
}

}  // namespace

Result<cv::Mat> read_image_gray(const std::filesystem::path& image, const Camera& camera) {
  Result<cv::Mat> gray = whole_image(image.string());
  if (!gray) return gray;
  const Status size = check_size(*gray, image.string(), camera);
  return size ? gray : size.error();
}

Result<cv::Mat> read_frame_gray(const Drive& drive, std::size_t frame_index) {
  const std::string place = place_of(drive, frame_index);
  const std::string image = drive.frame_path(drive.frames[frame_index]).string();
  const auto at_place = [&](Error error, const std::string& other_mend) {
    error.where = place;
    error.mend += other_mend;
    return error;
  };
  Result<cv::Mat> gray = whole_image(image);
  if (!gray) return at_place(gray.error(), " or remove the row");
  const Status size = check_size(*gray, image, drive.camera);
  return size ? gray : at_place(size.error(), "");
}

}  // namespace milepost
