#include "schema/drive/description.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "schema/base/file.h"
#include "schema/base/json.h"
#include "schema/drive/checks.h"

namespace milepost {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

// The message of a JSON error without the library's own error number.
std::string message_of(const Json::exception& error) {
  const std::string text = error.what();
  const std::size_t end = text.find("] ");
  return end == std::string::npos ? text : text.substr(end + 2);
}

// Reads values of drive.json by key and keeps the first error; later reads return defaults.
class KeyReader {
 public:
  explicit KeyReader(std::string file) : file_(std::move(file)) {}

  const Json& object(const Json& parent, const std::string& key) {
    return member(parent, key, "an object", &Json::is_object);
  }

  std::string text(const Json& parent, const std::string& key, const std::string& prefix = "") {
    const Json& value = member(parent, key, "a string", &Json::is_string, prefix);
    return value.is_string() ? value.get<std::string>() : "";
  }

  std::string optional_text(const Json& parent, const std::string& key) {
    return parent.is_object() && parent.contains(key) ? text(parent, key) : "";
  }

  std::optional<double> optional_number(const Json& parent, const std::string& key) {
    if (!parent.is_object() || !parent.contains(key)) return std::nullopt;
    return number(parent, "", key);
  }

  double number(const Json& parent, const std::string& prefix, const std::string& key) {
    const Json& value = member(parent, key, "a number", &Json::is_number, prefix);
    return value.is_number() ? value.get<double>() : 0;
  }

  int side_px(const Json& parent, const std::string& key) {
    const Json& value = member(parent, key, "a whole number", &Json::is_number_integer, "camera.");
    if (!value.is_number_integer()) return 0;
    using Limits = std::numeric_limits<int>;
    const auto side = value.get<std::int64_t>();
    return static_cast<int>(std::clamp<std::int64_t>(side, Limits::min(), Limits::max()));
  }

  std::pair<double, double> number_pair(const Json& parent, const std::string& key) {
    const Json& value = member(parent, key, "two numbers", &Json::is_array, "camera.");
    if (!value.is_array()) return {};
    if (value.size() != 2 || !value[0].is_number() || !value[1].is_number()) {
      fail("camera." + key, "is not two numbers");
      return {};
    }
    return {value[0].get<double>(), value[1].get<double>()};
  }

  // Keys of an object in which a misspelt one would change what is measured.
  void only(const Json& object, const std::vector<std::string>& known, const std::string& prefix) {
    if (!object.is_object()) return;
    std::string all;
    for (const std::string& key : known) all += (all.empty() ? "" : ", ") + key;
    for (const auto& [key, value] : object.items()) {
      if (std::ranges::find(known, key) == known.end())
        fail(prefix + key, "is not known", "write one of " + all);
    }
  }

  void fail(const std::string& key, const std::string& what,
            const std::string& hint = "correct it as the drive format describes") {
    if (status_) status_ = Error{ErrorCode::invalid_input, file_, key + " " + what, hint};
  }

  const Status& status() const { return status_; }

 private:
  using TypeTest = bool (Json::*)() const noexcept;

  const Json& member(const Json& parent, const std::string& key, const std::string& type,
                     TypeTest is_type, const std::string& prefix = "") {
    static const Json nothing;
    if (!parent.is_object()) return nothing;  // already reported
    const auto found = parent.find(key);
    if (found == parent.end()) {
      fail(prefix + key, "is missing");
      return nothing;
    }
    if (!((*found).*is_type)()) {
      fail(prefix + key, "is not " + type);
      return nothing;
    }
    return *found;
  }

  std::string file_;
  Status status_;
};

using MountingKey = std::pair<const char*, double Mounting::*>;
constexpr std::array<MountingKey, 6> kMountingKeys = {{{"forward_m", &Mounting::forward_m},
                                                       {"right_m", &Mounting::right_m},
                                                       {"up_m", &Mounting::up_m},
                                                       {"yaw_deg", &Mounting::yaw_deg},
                                                       {"pitch_deg", &Mounting::pitch_deg},
                                                       {"roll_deg", &Mounting::roll_deg}}};

Lens lens_of(KeyReader& keys, const Json& camera) {
  const std::string prefix = "camera.distortion.";
  if (!camera.is_object() || !camera.contains("distortion")) return {};
  if (!camera["distortion"].is_object()) {
    keys.fail("camera.distortion", "is not an object",
              R"(write {"model": "brown-conrady", "k1": ..., "k2": ..., "p1": ..., "p2": ..., )"
              R"("k3": ...} or {"model": "kannala-brandt", "k1": ... to "k4": ...})");
    return {};
  }
  const Json& object = camera["distortion"];
  const std::string name = keys.text(object, "model", prefix);
  const std::optional<LensModel> model = lens_model_named(name);
  if (!model) {
    keys.fail(prefix + "model", "is '" + name + "'",
              "write brown-conrady, kannala-brandt (fisheye) or pinhole");
    return {};
  }
  std::vector<double> coefficients;
  std::vector<std::string> known = {"model"};
  for (const std::string& coefficient : coefficient_names(*model)) {
    known.push_back(coefficient);
    coefficients.push_back(object.contains(coefficient) ? keys.number(object, prefix, coefficient)
                                                        : 0);
  }
  keys.only(object, known, prefix);
  const Result<Lens> lens = Lens::make(*model, coefficients);
  if (!lens) {
    keys.fail("camera.distortion:", lens.error().what, lens.error().hint);
    return {};
  }
  return *lens;
}

Mounting mounting_of(KeyReader& keys, const Json& root) {
  Mounting mounting;
  if (!root.is_object() || !root.contains("mounting")) return mounting;
  const Json& object = keys.object(root, "mounting");
  if (!object.is_object()) return mounting;
  const std::string prefix = "mounting.";
  std::vector<std::string> known;
  for (const auto& [key, value] : kMountingKeys) {
    known.emplace_back(key);
    if (object.contains(key)) mounting.*value = keys.number(object, prefix, key);
  }
  keys.only(object, known, prefix);
  return mounting;
}

Camera camera_of(KeyReader& keys, const Json& root) {
  const Json& object = keys.object(root, "camera");
  keys.only(object, {"width_px", "height_px", "focal_px", "principal_px", "distortion"}, "camera.");
  Camera camera;
  camera.lens = lens_of(keys, object);
  camera.mounting = mounting_of(keys, root);
  camera.width_px = keys.side_px(object, "width_px");
  camera.height_px = keys.side_px(object, "height_px");
  Pinhole& pinhole = camera.pinhole;
  std::tie(pinhole.focal_x_px, pinhole.focal_y_px) = keys.number_pair(object, "focal_px");
  std::tie(pinhole.principal_x_px, pinhole.principal_y_px) =
      keys.number_pair(object, "principal_px");
  return camera;
}

OrderedJson distortion_of(const Lens& lens) {
  OrderedJson json = {{"model", name_of(lens.model())}};
  const std::vector<std::string>& names = coefficient_names(lens.model());
  const std::vector<double> coefficients = lens.coefficients();
  for (std::size_t i = 0; i < names.size(); ++i) json[names[i]] = coefficients[i];
  return json;
}

PositionFrame read_frame(KeyReader& keys, const Json& root) {
  const std::string frame = keys.text(root, "frame");
  if (frame != "local" && frame != "geographic") {
    keys.fail("frame", "is '" + frame + "', neither 'local' nor 'geographic'");
  }
  return frame == "local" ? PositionFrame::local : PositionFrame::geographic;
}

Datum read_datum(KeyReader& keys, const Json& root) {
  const std::string text = keys.optional_text(root, "datum");
  if (text.empty()) return {};
  Result<Datum> datum = Datum::from(text);
  if (datum) return std::move(*datum);
  keys.fail("datum", datum.error().what, datum.error().hint);
  return {};
}

GeoPoint read_origin(KeyReader& keys, const Json& root) {
  const Json& object = keys.object(root, "origin");
  const GeoPoint origin{keys.number(object, "origin.", "latitude_deg"),
                        keys.number(object, "origin.", "longitude_deg"),
                        keys.number(object, "origin.", "altitude_m")};
  if (!is_valid(origin)) {
    keys.fail("origin", "is not a position: latitude -90 to 90, longitude -180 to 180 degrees");
  }
  return origin;
}

Result<Json> parse(const fs::path& file) {
  const Result<std::string> text = read_text_file(file);
  if (!text) return text.error();
  Result<Json> root = read_json(*text);
  if (!root) {
    const Error& error = root.error();
    const std::string place = error.where.empty() ? "" : ", " + error.where;
    return Error{ErrorCode::invalid_input, file.string() + place, error.what, error.hint};
  }
  if (root->is_object()) return root;
  return Error{ErrorCode::invalid_input, file.string(), "is not a JSON object",
               "write it as the drive format describes"};
}

}  // namespace

Result<Drive> read_description(const fs::path& folder) {
  const fs::path file = folder / kDescriptionFile;
  const Result<Json> parsed = parse(file);
  if (!parsed) return parsed.error();
  const Json& root = *parsed;

  KeyReader keys(file.string());
  Drive drive;
  drive.folder = folder;
  drive.name = keys.text(root, "name");
  drive.camera = camera_of(keys, root);
  drive.position_frame = read_frame(keys, root);
  if (drive.position_frame == PositionFrame::local) drive.origin = read_origin(keys, root);
  drive.datum = read_datum(keys, root);
  drive.images = keys.text(root, "images");
  drive.captured = keys.optional_text(root, "captured");
  drive.licence = keys.optional_text(root, "licence");
  drive.source = keys.optional_text(root, "source");
  drive.position_error = {keys.optional_number(root, "position_sigma_m"),
                          keys.optional_number(root, "position_correlation_m"),
                          keys.optional_text(root, "position_group")};
  if (!keys.status()) return keys.status().error();

  if (Status status = check_camera(drive.camera, file.string()); !status) return status.error();
  Status status = check_images_folder(drive.images, file.string());
  if (status) status = check_position_error(drive.position_error, file.string());
  if (!status) return status.error();
  return drive;
}

Result<Camera> read_camera(const fs::path& file) {
  const Result<Json> parsed = parse(file);
  if (!parsed) return parsed.error();
  KeyReader keys(file.string());
  Camera camera = camera_of(keys, *parsed);
  if (!keys.status()) return keys.status().error();
  if (Status status = check_camera(camera, file.string()); !status) return status.error();
  return camera;
}

Result<std::string> description_text(const Drive& drive) {
  const Camera& camera = drive.camera;
  const Pinhole& pinhole = camera.pinhole;
  OrderedJson root;
  root["name"] = drive.name;
  root["camera"] = {{"width_px", camera.width_px},
                    {"height_px", camera.height_px},
                    {"focal_px", {pinhole.focal_x_px, pinhole.focal_y_px}},
                    {"principal_px", {pinhole.principal_x_px, pinhole.principal_y_px}}};
  if (!camera.lens.is_pinhole()) root["camera"]["distortion"] = distortion_of(camera.lens);
  if (!camera.mounting.is_at_reference_point()) {
    for (const auto& [key, value] : kMountingKeys) root["mounting"][key] = camera.mounting.*value;
  }
  if (drive.position_frame == PositionFrame::local) {
    root["frame"] = "local";
    root["origin"] = {{"latitude_deg", drive.origin->latitude_deg},
                      {"longitude_deg", drive.origin->longitude_deg},
                      {"altitude_m", drive.origin->altitude_m}};
  } else {
    root["frame"] = "geographic";
  }
  if (drive.datum.is_stated()) root["datum"] = drive.datum.text();
  root["images"] = drive.images;
  if (!drive.captured.empty()) root["captured"] = drive.captured;
  if (!drive.licence.empty()) root["licence"] = drive.licence;
  if (!drive.source.empty()) root["source"] = drive.source;
  const StatedPositionError& stated = drive.position_error;
  if (stated.sigma_m) root["position_sigma_m"] = *stated.sigma_m;
  if (stated.correlation_m) root["position_correlation_m"] = *stated.correlation_m;
  if (!stated.group.empty()) root["position_group"] = stated.group;
  try {
    return root.dump(2) + "\n";
  } catch (const Json::exception& error) {
    return Error{ErrorCode::invalid_input, kDescriptionFile, message_of(error),
                 "write the drive's texts in UTF-8"};
  }
}

}  // namespace milepost
