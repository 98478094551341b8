#include "client/cli/backdrop.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "schema/base/file.h"
#include "schema/drive/image_bytes.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;

constexpr int kMostPixels = 1600;  // of width or height
constexpr int kJpegQuality = 82;
constexpr const char* kWarpMend =
    "bring the picture into degrees by gdalwarp -t_srs EPSG:4326, then gdal_translate -co "
    "WORLDFILE=YES";

// .pgw of .png, .jgw of .jpg and .jpeg: the first and the last letter of the ending, and a w.
std::string usual_ending(const fs::path& image) {
  const std::string ending = image.extension().string();
  if (ending.size() < 3) return ".wld";
  return {'.', ending[1], ending.back(), 'w'};
}

Result<fs::path> world_file_beside(const fs::path& image) {
  const std::string usual = usual_ending(image);
  for (const std::string& ending : {std::string(".wld"), usual}) {
    fs::path file = image;
    file.replace_extension(ending);
    if (fs::exists(file)) return file;
  }
  return Error{ErrorCode::not_found, image.string(),
               "no world file (.wld or " + usual + ") beside the image",
               "make it by gdal_translate -co WORLDFILE=YES"};
}

Result<double> number_of(const std::string& line, const std::string& place) {
  const std::size_t from = line.find_first_not_of(" \t\r");
  const std::size_t to = line.find_last_not_of(" \t\r");
  const std::string text = from == std::string::npos ? "" : line.substr(from, to - from + 1);
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code == std::errc() && end == text.data() + text.size() && std::isfinite(value)) return value;
  return Error{ErrorCode::invalid_input, place, "'" + text + "' is not a number",
               "a world file has six lines with a number each"};
}

Result<WorldFile> read_world_file(const fs::path& file) {
  const Result<std::string> text = read_text_file(file);
  if (!text) return text.error();
  std::istringstream lines(*text);
  std::array<double, 6> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    std::string line;
    std::getline(lines, line);
    const Result<double> value = number_of(line, file.string() + ", line " + std::to_string(i + 1));
    if (!value) return value.error();
    numbers.at(i) = *value;
  }
  const auto [a, d, b, e, c, f] = numbers;
  return WorldFile{a, d, b, e, c, f};
}

Result<cv::Mat> read_colour(const fs::path& image) {
  const Result<std::string> bytes = read_text_file(image);
  if (!bytes) return bytes.error();
  if (is_cut_short(as_bytes(*bytes))) {
    return Error{ErrorCode::invalid_input, image.string(), "the image is cut short",
                 "copy the image again"};
  }
  cv::Mat decoded;
  try {
    const std::vector<unsigned char> buffer(bytes->begin(), bytes->end());
    // The world file is about the pixels as they lie in the file, whatever EXIF says of them.
    decoded = cv::imdecode(buffer, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {  // for example, more pixels than the decoder allows
    decoded.release();
  }
  if (!decoded.empty()) return decoded;
  return Error{ErrorCode::invalid_input, image.string(), "the image cannot be decoded",
               "give a PNG or JPEG"};
}

Bytes small_jpeg(const cv::Mat& image) {
  const double scale =
      std::min(1.0, static_cast<double>(kMostPixels) / std::max(image.cols, image.rows));
  const cv::Size size(std::max(1, static_cast<int>(std::lround(image.cols * scale))),
                      std::max(1, static_cast<int>(std::lround(image.rows * scale))));
  cv::Mat small;
  cv::resize(image, small, size, 0, 0, cv::INTER_AREA);
  Bytes jpeg;
  cv::imencode(".jpg", small, jpeg, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  return jpeg;
}

}  // namespace

Bounds Backdrop::bounds() const {
  const double bottom_right_latitude_deg =
      top_right.latitude_deg + bottom_left.latitude_deg - top_left.latitude_deg;
  const double bottom_right_longitude_deg =
      top_right.longitude_deg + bottom_left.longitude_deg - top_left.longitude_deg;
  const auto [south, north] = std::minmax({top_left.latitude_deg, top_right.latitude_deg,
                                           bottom_left.latitude_deg, bottom_right_latitude_deg});
  const auto [west, east] = std::minmax({top_left.longitude_deg, top_right.longitude_deg,
                                         bottom_left.longitude_deg, bottom_right_longitude_deg});
  return {west, south, east, north};
}

Result<Backdrop> read_backdrop(const fs::path& image) {
  const Result<cv::Mat> pixels = read_colour(image);
  if (!pixels) return pixels.error();
  const Result<fs::path> file = world_file_beside(image);
  if (!file) return file.error();
  const Result<WorldFile> world = read_world_file(*file);
  if (!world) return world.error();
  if (world->a * world->e == world->b * world->d) {
    return Error{ErrorCode::invalid_input, file->string(),
                 "lines 1 to 4: a picture of that size covers nothing", kWarpMend};
  }
  const double right = pixels->cols - 0.5;
  const double bottom = pixels->rows - 0.5;
  Backdrop backdrop;
  backdrop.top_left = world->at(-0.5, -0.5);
  backdrop.top_right = world->at(right, -0.5);
  backdrop.bottom_left = world->at(-0.5, bottom);
  if (!backdrop.bounds().is_valid()) {
    return Error{ErrorCode::invalid_input, file->string(),
                 "lines 5 and 6: the picture reaches beyond the Earth's degrees", kWarpMend};
  }
  backdrop.jpeg = small_jpeg(*pixels);
  return backdrop;
}

}  // namespace milepost
