#include "client/evaluate/report/backdrop.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "schema/base/file.h"
#include "schema/drive/image_decode.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;

constexpr int kMostPixels = 1600;  // of width or height
constexpr int kJpegQuality = 82;
constexpr double kColourLeft = 0.2;
constexpr const char* kWarpHint =
    "make the image with gdalwarp -t_srs EPSG:4326, then gdal_translate -of JPEG -co WORLDFILE=YES";

// The usual extension of a format's world file, .pgw for .png and .jgw for .jpg and .jpeg: the
// first and the last letter of the image's extension, and a w.
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
               "no world file (.wld or " + usual + ") next to the image", kWarpHint};
}

Result<double> number_of(const std::string& line, const std::string& place) {
  const std::size_t from = line.find_first_not_of(" \t\r");
  const std::size_t to = line.find_last_not_of(" \t\r");
  const std::string text = from == std::string::npos ? "" : line.substr(from, to - from + 1);
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code == std::errc() && end == text.data() + text.size() && std::isfinite(value)) return value;
  return Error{ErrorCode::invalid_input, place, "'" + text + "' is not a number",
               "a world file has six lines with one number each"};
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
  Result<std::string> bytes = read_text_file(image);
  if (!bytes) return bytes.error();
  // The world file refers to the pixels as stored in the file, whatever their EXIF orientation.
  Result<cv::Mat> decoded =
      decoded_image(std::move(*bytes), cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  if (decoded) return decoded;
  const Error& error = decoded.error();
  return Error{error.code, image.string(), "the image " + error.what, error.hint};
}

cv::Mat scaled_down(const cv::Mat& image) {
  const double scale =
      std::min(1.0, static_cast<double>(kMostPixels) / std::max(image.cols, image.rows));
  const cv::Size size(std::max(1, static_cast<int>(std::lround(image.cols * scale))),
                      std::max(1, static_cast<int>(std::lround(image.rows * scale))));
  cv::Mat small;
  cv::resize(image, small, size, 0, 0, cv::INTER_AREA);
  return small;
}

// The image with most of its colour removed.
cv::Mat muted(const cv::Mat& bgr) {
  cv::Mat gray;
  cv::cvtColor(bgr, gray, cv::COLOR_BGR2GRAY);
  cv::cvtColor(gray, gray, cv::COLOR_GRAY2BGR);
  cv::Mat mixed;
  cv::addWeighted(bgr, kColourLeft, gray, 1 - kColourLeft, 0, mixed);
  return mixed;
}

Bytes jpeg_of(const cv::Mat& image) {
  Bytes jpeg;
  cv::imencode(".jpg", image, jpeg, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  return jpeg;
}

// Outer corners of a part of an image. Pixel coordinates refer to pixel centres, so the corners lie
// half a pixel outside the outermost centres.
struct Corners {
  Corners(const WorldFile& world, const cv::Rect& part)
      : top_left(world.at({part.x - 0.5, part.y - 0.5})),
        top_right(world.at({part.br().x - 0.5, part.y - 0.5})),
        bottom_left(world.at({part.x - 0.5, part.br().y - 0.5})),
        bottom_right(world.at({part.br().x - 0.5, part.br().y - 0.5})) {}

  GeoPoint top_left, top_right, bottom_left, bottom_right;
};

// The pixels of an image that cover a box; empty if they do not overlap.
cv::Rect part_around(const Backdrop& backdrop, const Bounds& box) {
  const std::array<cv::Point2d, 4> corners = {backdrop.world.project(box.south_deg, box.west_deg),
                                              backdrop.world.project(box.south_deg, box.east_deg),
                                              backdrop.world.project(box.north_deg, box.west_deg),
                                              backdrop.world.project(box.north_deg, box.east_deg)};
  const auto [left, right] = std::minmax({corners[0].x, corners[1].x, corners[2].x, corners[3].x});
  const auto [top, bottom] = std::minmax({corners[0].y, corners[1].y, corners[2].y, corners[3].y});
  // Clamped before the conversion to int, which would overflow for a distant box.
  const auto pixel = [](double place, int pixels) {
    return static_cast<int>(std::clamp(place, 0.0, static_cast<double>(pixels)));
  };
  const int cols = backdrop.bgr.cols;
  const int rows = backdrop.bgr.rows;
  return {cv::Point(pixel(std::floor(left + 0.5), cols), pixel(std::floor(top + 0.5), rows)),
          cv::Point(pixel(std::ceil(right + 0.5), cols), pixel(std::ceil(bottom + 0.5), rows))};
}

}  // namespace

cv::Point2d WorldFile::project(double latitude_deg, double longitude_deg) const {
  const double east_deg = longitude_deg - c;
  const double north_deg = latitude_deg - f;
  return {(e * east_deg - b * north_deg) / determinant(),
          (a * north_deg - d * east_deg) / determinant()};
}

Bounds Backdrop::bounds() const {
  const Corners corners(world, {0, 0, bgr.cols, bgr.rows});
  const auto [south, north] =
      std::minmax({corners.top_left.latitude_deg, corners.top_right.latitude_deg,
                   corners.bottom_left.latitude_deg, corners.bottom_right.latitude_deg});
  const auto [west, east] =
      std::minmax({corners.top_left.longitude_deg, corners.top_right.longitude_deg,
                   corners.bottom_left.longitude_deg, corners.bottom_right.longitude_deg});
  return {west, south, east, north};
}

Result<Backdrop> read_backdrop(const fs::path& image) {
  const Result<cv::Mat> pixels = read_colour(image);
  if (!pixels) return pixels.error();
  const Result<fs::path> file = world_file_beside(image);
  if (!file) return file.error();
  const Result<WorldFile> world = read_world_file(*file);
  if (!world) return world.error();
  if (world->determinant() == 0) {
    return Error{ErrorCode::invalid_input, file->string(), "lines 1 to 4: the pixels cover no area",
                 kWarpHint};
  }
  Backdrop backdrop{*pixels, *world};
  if (backdrop.bounds().is_valid()) return backdrop;
  return Error{ErrorCode::invalid_input, file->string(),
               "lines 5 and 6: the image extends beyond valid WGS84 degrees", kWarpHint};
}

std::optional<PagePicture> page_picture(const Backdrop& backdrop, const Bounds& shown) {
  const cv::Rect part = part_around(backdrop, shown);
  if (part.empty()) return std::nullopt;
  const Corners corners(backdrop.world, part);
  return PagePicture{jpeg_of(muted(scaled_down(backdrop.bgr(part)))), corners.top_left,
                     corners.top_right, corners.bottom_left};
}

}  // namespace milepost
