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

using Json = nlohmann::ordered_json;

using FindDirections = VanishingDirections (*)(const cv::Mat& gray, const Pinhole& view,
                                               const VanishingSettings& settings);
const std::map<std::string, FindDirections> kMethods = {
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

Json json_of(const VanishingLine& line) {
  const LineSegment& segment = line.segment;
  Json row = {segment.start_px.x(), segment.start_px.y(), segment.end_px.x(), segment.end_px.y()};
  row.push_back(line.direction ? static_cast<int>(*line.direction) : -1);
  return row;
}

Json json_of(const std::string& image, const VanishingDirections& found) {
  Json entry = {{"image", image}, {"directions", Json::array()}, {"lines", Json::array()}};
  for (const VanishingDirection& direction : found.directions) {
    entry["directions"].push_back(json_of(direction));
  }
  for (const VanishingLine& line : found.lines) entry["lines"].push_back(json_of(line));
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
    entries.push_back(json_of(image, find(*gray, camera.pinhole, settings)));
  }
  return entries;
}

// Errors: invalid_input for a name that is not UTF-8.
Result<std::string> text_of(const Json& entries, const std::string& out) {
  try {
    return entries.dump() + "\n";
  } catch (const Json::exception&) {
    return Error{ErrorCode::invalid_input, out, "an image's name is not UTF-8", "rename the image"};
  }
}

}  // namespace

int run_vanishing(const std::string& program, std::vector<std::string> words) {
  CLI::App app(
      "Finds, in each image, the directions of the edges of buildings: the vertical, and the "
      "horizontal\n"
      "ones, which are the orientations of walls relative to the camera.\n\n"
      "FILE gets a list with one object an image, in the order of the call: image; directions, "
      "each "
      "with\n"
      "direction [x, y, z] (unit vector, x right, y down, z forward; its opposite means the same), "
      "lines\n"
      "(how many belong to it) and orientation (vertical or horizontal); lines, each [x1, y1, x2, "
      "y2, "
      "index]\n"
      "in pixels, the longest first, index of its direction from 0, or -1 for a line of none.\n"
      "Methods: evidence (lines vote by their own noise, then all directions are refined together) "
      "and\n"
      "clustering (the aerial paper's: subtractive clustering of where lines meet).\n"
      "Images have the camera's size and no lens distortion.\n"
      "Example: milepost-client vanishing --camera drives/tuesday/drive.json --out found.json \\\n"
      "           drives/tuesday/frames/*.jpg",
      program);
  std::string camera_file;
  std::string out;
  std::string method = "evidence";
  std::vector<std::string> images;
  VanishingSettings settings;
  app.add_option("--camera", camera_file, "A drive.json, of which the camera is read")
      ->required()
      ->option_text("FILE");
  app.add_option("--out", out, "File to write the directions to; an old one is replaced")
      ->required()
      ->option_text("FILE");
  app.add_option("--method", method, "How to find them (default " + method + ")")
      ->check(CLI::IsMember(kMethods))
      ->option_text("M");
  add_number(app, "--max-tilt-deg", settings.max_tilt_deg, "DEG",
             "Greatest tilt of the camera, roll and pitch together", 1, 44);
  app.add_option("IMAGE", images, "Images to look at")->required()->option_text("IMAGE...");
  if (const auto code = parse_words(app, std::move(words))) return *code;

  const Result<Camera> camera = read_camera(camera_file);
  if (!camera) return fail(program, camera.error());
  std::vector<std::filesystem::path> inputs(images.begin(), images.end());
  inputs.emplace_back(camera_file);
  if (const Status free = check_outputs({{"--out", out, &kDirectionsOutput}}, inputs); !free) {
    return fail(program, free.error());
  }
  catch_stop_signals();
  const Result<Json> entries = found_in_all(images, *camera, kMethods.at(method), settings);
  if (!entries) return fail(program, entries.error());
  const Result<std::string> text = text_of(*entries, out);
  if (!text) return fail(program, text.error());
  const Status written = write_text_file(out, *text);
  if (!written.ok()) return fail(program, written.error());
  report_stream(out) << out << ": " << images.size() << " images\n";
  return kExitDone;
}

}  // namespace milepost
