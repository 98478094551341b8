#include "mapper/import/colmap_model.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <sstream>

#include "schema/base/file.h"
#include "schema/base/number.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little);

// COLMAP's camera models by their numbers: how many of the parameters are focal lengths, after
// which the principal point follows, and which of ours their other parameters are.
struct ColmapCameraModel {
  const char* name;
  std::size_t focal_lengths;
  std::size_t coefficients;
  LensModel lens;
  bool is_supported;
};
constexpr std::array<ColmapCameraModel, 11> kModels = {
    {{"SIMPLE_PINHOLE", 1, 0, LensModel::pinhole, true},
     {"PINHOLE", 2, 0, LensModel::pinhole, true},
     {"SIMPLE_RADIAL", 1, 1, LensModel::brown_conrady, true},
     {"RADIAL", 1, 2, LensModel::brown_conrady, true},
     {"OPENCV", 2, 4, LensModel::brown_conrady, true},
     {"OPENCV_FISHEYE", 2, 4, LensModel::kannala_brandt, true},
     {"FULL_OPENCV", 2, 8, LensModel::brown_conrady, true},
     {"FOV", 2, 1, LensModel::pinhole, false},
     {"SIMPLE_RADIAL_FISHEYE", 1, 1, LensModel::kannala_brandt, true},
     {"RADIAL_FISHEYE", 1, 2, LensModel::kannala_brandt, true},
     {"THIN_PRISM_FISHEYE", 2, 8, LensModel::kannala_brandt, false}}};

Error wrong(const std::string& where, const std::string& what,
            const std::string& hint = "export the model of COLMAP again") {
  return {ErrorCode::invalid_input, where, what, hint};
}

// `parameters` has as many as the model.
Result<Camera> camera_of(const ColmapCameraModel& model, std::uint64_t width_px,
                         std::uint64_t height_px, std::span<const double> parameters,
                         const std::string& where) {
  if (!model.is_supported) {
    return wrong(where, std::string("the camera model ") + model.name + " is not known here",
                 "reconstruct with OPENCV, FULL_OPENCV or OPENCV_FISHEYE");
  }
  // A pixel's centre is at a half there, at a whole number here.
  constexpr double kHalfPixel = 0.5;
  const std::size_t centre = model.focal_lengths;
  Camera camera{static_cast<int>(std::min<std::uint64_t>(width_px, 1U << 30U)),
                static_cast<int>(std::min<std::uint64_t>(height_px, 1U << 30U)),
                {parameters[0], parameters[centre - 1], parameters[centre] - kHalfPixel,
                 parameters[centre + 1] - kHalfPixel}};
  const auto rest = parameters.subspan(centre + 2);
  Result<Lens> lens = Lens::make(model.lens, {rest.begin(), rest.end()});
  if (!lens) return wrong(where, lens.error().what, lens.error().hint);
  camera.lens = *lens;
  return camera;
}

std::size_t parameters_of(const ColmapCameraModel& model) {
  return model.focal_lengths + 2 + model.coefficients;
}

// `pose` is a rotation qw qx qy qz and a translation, from the world to the camera.
Result<ColmapImage> image_of(std::string name, std::uint32_t camera,
                             const std::array<double, 7>& pose, const std::string& where) {
  const Eigen::Quaterniond rotation(pose[0], pose[1], pose[2], pose[3]);
  const Eigen::Vector3d translation(pose[4], pose[5], pose[6]);
  const bool is_sound = std::abs(rotation.norm() - 1) < 0.01 && translation.allFinite();
  if (!is_sound || name.empty()) return wrong(where, "an image has no sound pose or no name");
  Eigen::Isometry3d camera_from_world(rotation.normalized());
  camera_from_world.pretranslate(translation);
  return ColmapImage{std::move(name), camera, camera_from_world.inverse()};
}

// Takes values from the begin of bytes; after the end there are none.
class ByteCursor {
 public:
  explicit ByteCursor(std::string_view bytes) : left_(bytes) {}

  template <class Value>
  std::optional<Value> take() {
    if (left_.size() < sizeof(Value)) return std::nullopt;
    Value value;
    std::memcpy(&value, left_.data(), sizeof(Value));
    left_.remove_prefix(sizeof(Value));
    return value;
  }

  std::optional<std::string> take_text() {
    const std::size_t end = left_.find('\0');
    if (end == std::string_view::npos) return std::nullopt;
    std::string text(left_.substr(0, end));
    left_.remove_prefix(end + 1);
    return text;
  }

  bool skip(std::uint64_t count, std::size_t each) {
    if (count > left_.size() / each) return false;
    left_.remove_prefix(count * each);
    return true;
  }

 private:
  std::string_view left_;
};

Result<std::map<std::uint32_t, Camera>> binary_cameras(const fs::path& file) {
  const Result<std::string> bytes = read_text_file(file);
  if (!bytes) return bytes.error();
  ByteCursor cursor(*bytes);
  const auto count = cursor.take<std::uint64_t>();
  const Error cut = wrong(file.string(), "ends within a camera");
  if (!count) return cut;
  std::map<std::uint32_t, Camera> cameras;
  for (std::uint64_t i = 0; i < *count; ++i) {
    const auto id = cursor.take<std::uint32_t>();
    const auto number = cursor.take<std::int32_t>();
    const auto width_px = cursor.take<std::uint64_t>();
    const auto height_px = cursor.take<std::uint64_t>();
    if (!height_px) return cut;
    const std::string where = file.string() + ", camera " + std::to_string(*id);
    if (*number < 0 || *number >= static_cast<std::int32_t>(kModels.size()))
      return wrong(where, "there is no camera model " + std::to_string(*number));
    const ColmapCameraModel& model = kModels[static_cast<std::size_t>(*number)];
    std::vector<double> parameters;
    for (std::size_t p = 0; p < parameters_of(model); ++p) {
      const auto value = cursor.take<double>();
      if (!value) return cut;
      parameters.push_back(*value);
    }
    const auto camera = camera_of(model, *width_px, *height_px, parameters, where);
    if (!camera) return camera.error();
    cameras.emplace(*id, *camera);
  }
  return cameras;
}

Result<std::vector<ColmapImage>> binary_images(const fs::path& file) {
  const Result<std::string> bytes = read_text_file(file);
  if (!bytes) return bytes.error();
  ByteCursor cursor(*bytes);
  const auto count = cursor.take<std::uint64_t>();
  const Error cut = wrong(file.string(), "ends within an image");
  if (!count) return cut;
  constexpr std::size_t kPointBytes = 24;  // x, y and the number of a point in space
  std::vector<ColmapImage> images;
  for (std::uint64_t i = 0; i < *count; ++i) {
    const auto id = cursor.take<std::uint32_t>();
    const auto pose = cursor.take<std::array<double, 7>>();
    const auto camera = cursor.take<std::uint32_t>();
    auto name = cursor.take_text();
    const auto points = cursor.take<std::uint64_t>();
    if (!pose || !name || !points || !cursor.skip(*points, kPointBytes)) return cut;
    auto image = image_of(std::move(*name), *camera, *pose,
                          file.string() + ", image " + std::to_string(*id));
    if (!image) return image.error();
    images.push_back(std::move(*image));
  }
  return images;
}

struct TextLine {
  std::size_t number = 0;
  std::vector<std::string> words;
};

// Lines that are no comments, also empty ones.
Result<std::vector<TextLine>> text_lines(const fs::path& file) {
  const Result<std::string> text = read_text_file(file);
  if (!text) return text.error();
  std::vector<TextLine> lines;
  std::istringstream stream(*text);
  std::string line;
  for (std::size_t number = 1; std::getline(stream, line); ++number) {
    if (line.starts_with('#')) continue;
    TextLine& taken = lines.emplace_back();
    taken.number = number;
    std::istringstream words(line);
    for (std::string word; words >> word;) taken.words.push_back(std::move(word));
  }
  return lines;
}

// The numbers in the words of a line from `first` on. Nothing if one is none.
std::optional<std::vector<double>> numbers_from(const TextLine& line, std::size_t first,
                                                std::size_t count) {
  std::vector<double> numbers;
  for (std::size_t i = first; i < first + count; ++i) {
    const auto value = i < line.words.size() ? finite_number(line.words[i]) : std::nullopt;
    if (!value) return std::nullopt;
    numbers.push_back(*value);
  }
  return numbers;
}

Result<std::map<std::uint32_t, Camera>> text_cameras(const fs::path& file) {
  const auto lines = text_lines(file);
  if (!lines) return lines.error();
  std::map<std::uint32_t, Camera> cameras;
  for (const TextLine& line : *lines) {
    if (line.words.empty()) continue;
    const std::string where = file.string() + ", line " + std::to_string(line.number);
    if (line.words.size() < 2) return wrong(where, "this is no camera");
    const auto model = std::ranges::find(kModels, line.words[1], &ColmapCameraModel::name);
    if (model == kModels.end())
      return wrong(where, "there is no camera model '" + line.words[1] + "'");
    const auto id = numbers_from(line, 0, 1);
    const auto size = numbers_from(line, 2, 2);
    const auto parameters = numbers_from(line, 4, parameters_of(*model));
    const bool is_sound = id && size && parameters && id->front() >= 0 && id->front() < 4e9 &&
                          size->front() >= 0 && size->back() >= 0;
    if (!is_sound) return wrong(where, "this is no camera");
    const auto camera = camera_of(*model, static_cast<std::uint64_t>(size->front()),
                                  static_cast<std::uint64_t>(size->back()), *parameters, where);
    if (!camera) return camera.error();
    cameras.emplace(static_cast<std::uint32_t>(id->front()), *camera);
  }
  return cameras;
}

// Each image has two lines, of which the second, with the points in it, may be empty.
Result<std::vector<ColmapImage>> text_images(const fs::path& file) {
  const auto lines = text_lines(file);
  if (!lines) return lines.error();
  std::vector<ColmapImage> images;
  for (std::size_t i = 0; i < lines->size(); i += 2) {
    const TextLine& line = (*lines)[i];
    if (line.words.empty()) continue;
    const std::string where = file.string() + ", line " + std::to_string(line.number);
    const auto numbers = numbers_from(line, 0, 9);
    if (!numbers || line.words.size() < 10 || (*numbers)[8] < 0 || (*numbers)[8] > 4e9)
      return wrong(where, "this is no image with its pose");
    std::array<double, 7> pose{};
    std::copy_n(numbers->begin() + 1, pose.size(), pose.begin());
    std::string name = line.words[9];
    for (std::size_t word = 10; word < line.words.size(); ++word) name += " " + line.words[word];
    auto image = image_of(std::move(name), static_cast<std::uint32_t>((*numbers)[8]), pose, where);
    if (!image) return image.error();
    images.push_back(std::move(*image));
  }
  return images;
}

}  // namespace

Result<ColmapModel> read_colmap_model(const fs::path& folder) {
  std::error_code error;
  const bool is_binary = fs::exists(folder / "images.bin", error);
  if (!is_binary && !fs::exists(folder / "images.txt", error)) {
    return Error{ErrorCode::not_found, folder.string(), "holds neither images.bin nor images.txt",
                 "name the folder of a model: sparse/0, say"};
  }
  auto cameras =
      is_binary ? binary_cameras(folder / "cameras.bin") : text_cameras(folder / "cameras.txt");
  if (!cameras) return cameras.error();
  auto images =
      is_binary ? binary_images(folder / "images.bin") : text_images(folder / "images.txt");
  if (!images) return images.error();
  return ColmapModel{std::move(*cameras), std::move(*images)};
}

}  // namespace milepost
