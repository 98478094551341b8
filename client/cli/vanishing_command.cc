#include <filesystem>
#include <map>
#include <ostream>
#include <string_view>

#include <nlohmann/json.hpp>

#include "client/cli/commands.h"
#include "client/evaluate/baselines/vanishing_clustering.h"
#include "client/global/vanishing_directions.h"
#include "schema/base/file.h"
#include "schema/base/output_file.h"
#include "schema/command/command.h"
#include "schema/drive/description.h"
#include "schema/drive/frame_image.h"
#include "schema/drive/grey_depth.h"

namespace milepost {
namespace {

constexpr const char* kVanishingDescription =
    R"(Finds the vanishing directions of building edges in images.

They are the vertical and the horizontal ones, which are the orientations of walls relative to the
camera. FILE gets a list with one object per image, in the order of the arguments: image; directions,
each with direction [x, y, z] (unit vector, x right, y down, z forward; its sign is arbitrary), lines
(the number that support it) and orientation (vertical or horizontal); lines, each
[x1, y1, x2, y2, index] in pixels, the longest first, with the index of its direction from 0, or -1.
Methods: evidence (each line votes with its own noise, then all directions are refined jointly) and
clustering (the aerial paper's: subtractive clustering of line intersections).
Images have the camera's size; its lens is that of drive.json. Places are those in the image.
Example: milepost-client vanishing --camera drives/tuesday/drive.json --out found.json \
           drives/tuesday/frames/*.jpg)";

struct VanishingOptions {
  std::string camera;
  std::string out;
  std::string method = "evidence";
  std::vector<std::string> images;
  VanishingSettings settings;
};

using Json = nlohmann::ordered_json;

using FindDirections = VanishingDirections (*)(const cv::Mat& gray, const Camera& camera,
                                               const VanishingSettings& settings);
const std::map<std::string, FindDirections> kVanishingMethods = {
    {"clustering", clustered_vanishing_directions}, {"evidence", vanishing_directions}};

bool begins_directions(std::string_view head) {
  return begins_without_space(head, R"([{"image":)");
}

constexpr OutputKind kDirectionsOutput = {"a list of vanishing directions", begins_directions,
                                          true};

Json json_of(const VanishingDirection& found) {
  const Eigen::Vector3d& direction = found.direction;
  return {{"direction", {direction.x(), direction.y(), direction.z()}},
          {"lines", found.lines},
          {"orientation", found.orientation == Orientation::vertical ? "vertical" : "horizontal"}};
}

Json json_of(const VanishingLine& line, const Camera& camera) {
  Json row = Json::array();
  for (const Eigen::Vector2d& end : {line.segment.start_px, line.segment.end_px}) {
    const Eigen::Vector2d shown = camera.image_from_pinhole(end).value_or(end);
    row.push_back(shown.x());
    row.push_back(shown.y());
  }
  row.push_back(line.direction ? static_cast<int>(*line.direction) : -1);
  return row;
}

Json json_of(const std::string& image, const VanishingDirections& found, const Camera& camera) {
  Json entry = {{"image", image}, {"directions", Json::array()}, {"lines", Json::array()}};
  for (const VanishingDirection& direction : found.directions) {
    entry["directions"].push_back(json_of(direction));
  }
  for (const VanishingLine& line : found.lines) entry["lines"].push_back(json_of(line, camera));
  return entry;
}

Result<Json> found_in_all(const std::vector<std::string>& images, const Camera& camera,
                          FindDirections find, const VanishingSettings& settings) {
  ProgressLine progress;
  Json entries = Json::array();
  const int grey_bits = grey_bits_of({images.begin(), images.end()});
  for (const std::string& image : images) {
    if (stop_requested()) {
      return Error{ErrorCode::cancelled, image, "stopped before this image", "start again"};
    }
    progress.show("image " + std::to_string(entries.size() + 1) + " of " +
                  std::to_string(images.size()));
    const Result<cv::Mat> gray = read_image_gray(image, camera, grey_bits);
    if (!gray) return gray.error();
    entries.push_back(json_of(image, find(*gray, camera, settings), camera));
  }
  return entries;
}

// Errors: invalid_input for a file name that is not UTF-8.
Result<std::string> text_of(const Json& entries, const std::string& out) {
  try {
    return entries.dump() + "\n";
  } catch (const Json::exception&) {
    return Error{ErrorCode::invalid_input, out, "an image's name is not UTF-8", "rename the image"};
  }
}

int find_vanishing_directions(const std::string& program, const VanishingOptions& options) {
  const Result<Camera> camera = read_camera(options.camera);
  if (!camera) return fail(program, camera.error());
  std::vector<std::filesystem::path> inputs(options.images.begin(), options.images.end());
  inputs.emplace_back(options.camera);
  if (const Status free = check_outputs({{"--out", options.out, &kDirectionsOutput}}, inputs);
      !free) {
    return fail(program, free.error());
  }
  catch_stop_signals();
  const Result<Json> entries =
      found_in_all(options.images, *camera, kVanishingMethods.at(options.method), options.settings);
  if (!entries) return fail(program, entries.error());
  const Result<std::string> text = text_of(*entries, options.out);
  if (!text) return fail(program, text.error());
  const Status written = write_text_file(options.out, *text);
  if (!written.ok()) return fail(program, written.error());
  report_stream(options.out) << options.out << ": " << options.images.size() << " images\n";
  return kExitDone;
}

}  // namespace

RunCommand add_vanishing(CLI::App& app) {
  app.description(kVanishingDescription);
  const auto options = std::make_shared<VanishingOptions>();
  app.add_option("--camera", options->camera, "drive.json to read the camera from")
      ->required()
      ->option_text("FILE");
  app.add_option("--out", options->out, "File to write the directions to; an old one is replaced")
      ->required()
      ->option_text("FILE");
  app.add_option("--method", options->method, "Method (default " + options->method + ")")
      ->check(CLI::IsMember(kVanishingMethods))
      ->option_text("M");
  add_number(app, "--max-tilt-deg", options->settings.max_tilt_deg, "DEG",
             "Maximum tilt of the camera, roll and pitch combined", 1, 44);
  app.add_option("IMAGE", options->images, "Images to process")
      ->required()
      ->option_text("IMAGE...");
  return [options, program = name_of(app)] { return find_vanishing_directions(program, *options); };
}

}  // namespace milepost
