#include "mapper/aerial/footprints.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "mapper/aerial/footprint_ring.h"
#include "mapper/aerial/geojson_kinds.h"
#include "schema/base/file.h"
#include "schema/base/json.h"

namespace milepost {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMinRingPoints = 4;  // the last repeats the first
constexpr std::size_t kMaxNameBytes = 60;  // of a quoted value in a message

// Enough for the outlines of a large city; reading them takes about 5 GB of memory.
constexpr JsonLimits kLimits{.bytes = 512'000'000, .values = 50'000'000, .depth = 64};

Error too_large(const std::string& name) {
  return {ErrorCode::invalid_input, name, "it is larger than 512 MB",
          "extract the area of the map (ogr2ogr -clipsrc W S E N)"};
}

// A value quoted for a message: on one line, truncated.
std::string in_message(const Json& value) {
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > kMaxNameBytes) text = text.substr(0, kMaxNameBytes) + "...";
  return text;
}

const Json* member(const Json& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  return found != object.end() ? &*found : nullptr;
}

std::string numbered(const std::string& place, std::size_t number) {
  return place + "[" + std::to_string(number) + "]";
}

// Reads one document; stores its name for messages.
class FootprintReader {
 public:
  explicit FootprintReader(const std::string& name) : name_(name) {}

  Result<Footprints> read(std::string_view text) {
    const Result<Json> root = read_json(text, kLimits);
    if (!root) return not_json(text, root.error());
    if (const auto kind = kind_of_other_json(*root)) {
      return Error{ErrorCode::invalid_input, name_, "this is " + kind->name + ", not GeoJSON",
                   "convert it (" + kind->converter + ")"};
    }
    if (const Status status = check_reference(*root); !status) return status.error();
    if (const Status status = add_object(*root, "the root"); !status) return status.error();
    return Footprints{std::move(walls_).finish(), census_.in_words()};
  }

 private:
  Error broken(const std::string& place, const std::string& what) const {
    return {ErrorCode::invalid_input, name_ + ", " + place, what,
            "give GeoJSON polygons in WGS84 degrees"};
  }

  Error not_json(std::string_view text, const Error& reason) const {
    if (text.size() > kLimits.bytes) return too_large(name_);
    if (is_line_delimited(text)) {
      return {ErrorCode::invalid_input, name_, "this is GeoJSON with one feature per line",
              "make one collection of it (ogr2ogr -f GeoJSON NEW.geojson GeoJSONSeq:OLD)"};
    }
    const std::string place = reason.where.empty() ? "" : ", " + reason.where;
    return {ErrorCode::invalid_input, name_ + place, reason.what,
            reason.where.empty() ? "extract the area of the map (ogr2ogr -clipsrc W S E N)"
                                 : "rewrite it as GeoJSON (ogr2ogr -f GeoJSON NEW.geojson OLD)"};
  }

  // Files from before RFC 7946 may name another coordinate reference system.
  Status check_reference(const Json& root) const {
    const Json* const reference = member(root, "crs");
    if (reference == nullptr || reference->is_null()) return ok_status();
    const Json* const properties = member(*reference, "properties");
    const Json* const name = properties != nullptr ? member(*properties, "name") : nullptr;
    if (name == nullptr || !name->is_string()) {
      return Error{ErrorCode::invalid_input, name_ + ", crs",
                   "it is " + in_message(*reference) + " and not an object with properties.name",
                   "leave it out if the coordinates are longitude and latitude in WGS84 degrees"};
    }
    const auto& text = name->get_ref<const std::string&>();
    if (text.ends_with("CRS84") || text.ends_with(":4326")) return ok_status();
    return Error{ErrorCode::invalid_input, name_ + ", crs",
                 "its coordinates are not WGS84 degrees but " + in_message(*name),
                 "convert it (ogr2ogr -t_srs EPSG:4326)"};
  }

  // A FeatureCollection, a Feature, or a geometry.
  // NOLINTNEXTLINE(misc-no-recursion): as deep as the limit of read_json
  Status add_object(const Json& object, const std::string& place) {
    const Json* const named = member(object, "type");
    if (named == nullptr || !named->is_string()) {
      return broken(place, "a GeoJSON object with its \"type\" is missing");
    }
    const auto& type = named->get_ref<const std::string&>();
    if (type == "FeatureCollection") return add_members(object, "features", place);
    if (type == "GeometryCollection") return add_members(object, "geometries", place);
    if (type == "Feature") return add_feature(object, place);
    if (!is_geojson_type(type)) return unknown_type(type, place);
    census_.count(type);
    if (type != "Polygon" && type != "MultiPolygon") return ok_status();
    const Json* const coordinates = member(object, "coordinates");
    if (coordinates == nullptr || !coordinates->is_array()) {
      return broken(place, "\"coordinates\" is missing");
    }
    if (type == "Polygon") return add_polygon(*coordinates, place + ".coordinates");
    for (std::size_t i = 0; i < coordinates->size(); ++i) {
      const Status status = add_polygon((*coordinates)[i], numbered(place + ".coordinates", i));
      if (!status) return status;
    }
    return ok_status();
  }

  // NOLINTNEXTLINE(misc-no-recursion): see add_object
  Status add_feature(const Json& feature, const std::string& place) {
    const Json* const geometry = member(feature, "geometry");
    if (geometry == nullptr) return broken(place, "\"geometry\" is missing");
    if (!geometry->is_null()) return add_object(*geometry, place + ".geometry");
    census_.count_bare_feature();
    return ok_status();
  }

  // NOLINTNEXTLINE(misc-no-recursion): see add_object
  Status add_members(const Json& object, const char* key, const std::string& place) {
    const Json* const members = member(object, key);
    if (members == nullptr || !members->is_array()) {
      return broken(place, "the list \"" + std::string(key) + "\" is missing");
    }
    for (std::size_t i = 0; i < members->size(); ++i) {
      const Status status = add_object((*members)[i], numbered(key, i));
      if (!status) return status;
    }
    return ok_status();
  }

  Error unknown_type(const std::string& type, const std::string& place) const {
    const std::string what = "the type " + in_message(type);
    if (const auto right = geojson_type_in_other_case(type)) {
      return {ErrorCode::invalid_input, name_ + ", " + place,
              what + " is written \"" + *right + "\"", "correct the capitals"};
    }
    return broken(place, what + " is not a GeoJSON type");
  }

  Status add_polygon(const Json& rings, const std::string& place) {
    if (!rings.is_array()) return broken(place, "a list of rings is missing");
    for (std::size_t i = 0; i < rings.size(); ++i) {
      const Status status =
          add_ring(rings[i], i == 0 ? RingKind::outer : RingKind::inner, numbered(place, i));
      if (!status) return status;
    }
    return ok_status();
  }

  Status add_ring(const Json& positions, RingKind kind, const std::string& place) {
    if (!positions.is_array() || positions.size() < kMinRingPoints) {
      return broken(place, "a ring needs at least 4 positions");
    }
    std::vector<WallEnd> ring;
    ring.reserve(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const Result<WallEnd> at = position(positions[i], place, i);
      if (!at) return at.error();
      ring.push_back(*at);
    }
    if (const auto wrong = walls_.add(std::move(ring), kind)) return broken(place, *wrong);
    return ok_status();
  }

  Result<WallEnd> position(const Json& json, const std::string& ring, std::size_t number) const {
    if (!json.is_array() || json.size() < 2 || !json[0].is_number() || !json[1].is_number()) {
      return broken(numbered(ring, number), "a position is [longitude, latitude]");
    }
    const WallEnd at{json[1].get<double>(), json[0].get<double>()};
    if (!(std::abs(at.latitude_deg) <= 90) || !(std::abs(at.longitude_deg) <= 360)) {
      return broken(numbered(ring, number), "this is not [longitude, latitude] in degrees");
    }
    return at;
  }

  const std::string& name_;
  RingWalls walls_;
  GeometryCensus census_;
};

}  // namespace

Result<Footprints> footprints_in(std::string_view text, const std::string& name) {
  return FootprintReader(name).read(text);
}

Result<Footprints> read_footprints(const fs::path& file) {
  std::error_code has_no_size;
  const std::uintmax_t bytes = fs::file_size(file, has_no_size);
  if (!has_no_size && bytes > kLimits.bytes) return too_large(file.string());
  const Result<std::string> text = read_text_file(file);
  if (!text) return text.error();
  return footprints_in(*text, file.string());
}

}  // namespace milepost
