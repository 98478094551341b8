#include "mapper/aerial/footprints.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <nlohmann/json.hpp>

#include "schema/base/file.h"

namespace milepost {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;
using Walls = std::vector<Wall>;

constexpr std::size_t kMinRingPoints = 4;  // the last is the first again
constexpr double kMaxWallDeg = 0.1;        // FORMAT.md 6.4

enum class Ring { outer, inner };

// Reads one file, keeping its name for messages.
class FootprintReader {
 public:
  explicit FootprintReader(const fs::path& file) : file_(file) {}

  Result<Walls> read() {
    const Result<std::string> text = read_text_file(file_);
    if (!text) return text.error();
    Json root;
    try {
      root = Json::parse(*text);
    } catch (const Json::parse_error& error) {
      return broken("byte " + std::to_string(error.byte), "this is not JSON");
    }
    if (const Status status = check_reference(root); !status) return status.error();
    if (const Status status = add_object(root, "the root"); !status) return status.error();
    return std::move(walls_);
  }

 private:
  Error broken(const std::string& place, const std::string& what) const {
    return {ErrorCode::invalid_input, file_.string() + ", " + place, what,
            "give GeoJSON polygons in WGS84 degrees"};
  }

  // Files from before RFC 7946 may name another reference.
  Status check_reference(const Json& root) const {
    if (!root.is_object() || !root.contains("crs") || root["crs"].is_null()) return ok_status();
    const Json name = root["crs"].value("/properties/name"_json_pointer, Json());
    if (name.is_string()) {
      const auto text = name.get<std::string>();
      if (text.ends_with("CRS84") || text.ends_with(":4326")) return ok_status();
    }
    return Error{ErrorCode::invalid_input, file_.string() + ", crs",
                 "its coordinates are not WGS84 degrees but " + name.dump(),
                 "convert it (ogr2ogr -t_srs EPSG:4326)"};
  }

  // A FeatureCollection, a Feature, or a geometry.
  Status add_object(const Json& object, const std::string& place) {
    if (!object.is_object() || !object.contains("type") || !object["type"].is_string()) {
      return broken(place, "a GeoJSON object with its \"type\" is missing");
    }
    const auto type = object["type"].get<std::string>();
    if (type == "FeatureCollection") return add_members(object, "features", place);
    if (type == "GeometryCollection") return add_members(object, "geometries", place);
    if (type == "Feature") {
      if (!object.contains("geometry")) return broken(place, "\"geometry\" is missing");
      if (object["geometry"].is_null()) return ok_status();
      return add_object(object["geometry"], place + ".geometry");
    }
    if (type != "Polygon" && type != "MultiPolygon") return ok_status();
    if (!object.contains("coordinates") || !object["coordinates"].is_array()) {
      return broken(place, "\"coordinates\" is missing");
    }
    const Json& coordinates = object["coordinates"];
    if (type == "Polygon") return add_polygon(coordinates, place + ".coordinates");
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      const Status status = add_polygon(coordinates[i], numbered(place + ".coordinates", i));
      if (!status) return status;
    }
    return ok_status();
  }

  Status add_members(const Json& object, const std::string& key, const std::string& place) {
    if (!object.contains(key) || !object[key].is_array()) {
      return broken(place, "the list \"" + key + "\" is missing");
    }
    for (std::size_t i = 0; i < object[key].size(); ++i) {
      const Status status = add_object(object[key][i], numbered(key, i));
      if (!status) return status;
    }
    return ok_status();
  }

  Status add_polygon(const Json& rings, const std::string& place) {
    if (!rings.is_array()) return broken(place, "a list of rings is missing");
    for (std::size_t i = 0; i < rings.size(); ++i) {
      const Status status =
          add_ring(rings[i], i == 0 ? Ring::outer : Ring::inner, numbered(place, i));
      if (!status) return status;
    }
    return ok_status();
  }

  Status add_ring(const Json& positions, Ring kind, const std::string& place) {
    if (!positions.is_array() || positions.size() < kMinRingPoints) {
      return broken(place, "a ring has at least 4 positions");
    }
    std::vector<WallEnd> ring;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const Result<WallEnd> at = position(positions[i], numbered(place, i));
      if (!at) return at.error();
      ring.push_back(*at);
    }
    if (ring.front() != ring.back())
      return broken(place, "the ring's last position is not its first");
    if (is_clockwise(ring) != (kind == Ring::outer)) std::reverse(ring.begin(), ring.end());
    for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
      if (ring[i] == ring[i + 1]) continue;
      if (std::abs(ring[i].latitude_deg - ring[i + 1].latitude_deg) > kMaxWallDeg ||
          std::abs(ring[i].longitude_deg - ring[i + 1].longitude_deg) > kMaxWallDeg) {
        return broken(place, "a wall is longer than 0.1 degrees");
      }
      walls_.push_back({ring[i], ring[i + 1]});
    }
    return ok_status();
  }

  Result<WallEnd> position(const Json& json, const std::string& place) const {
    if (!json.is_array() || json.size() < 2 || !json[0].is_number() || !json[1].is_number()) {
      return broken(place, "a position is [longitude, latitude]");
    }
    const WallEnd at{json[1].get<double>(), json[0].get<double>()};
    if (!(std::abs(at.latitude_deg) <= 90) || !(std::abs(at.longitude_deg) <= 180)) {
      return broken(place, "this is not [longitude, latitude] in degrees");
    }
    return at;
  }

  static bool is_clockwise(const std::vector<WallEnd>& ring) {
    double twice_area = 0;
    const WallEnd& origin = ring.front();
    for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
      const double x1 = ring[i].longitude_deg - origin.longitude_deg;
      const double y1 = ring[i].latitude_deg - origin.latitude_deg;
      const double x2 = ring[i + 1].longitude_deg - origin.longitude_deg;
      const double y2 = ring[i + 1].latitude_deg - origin.latitude_deg;
      twice_area += x1 * y2 - x2 * y1;
    }
    return twice_area < 0;
  }

  static std::string numbered(const std::string& place, std::size_t number) {
    return place + "[" + std::to_string(number) + "]";
  }

  const fs::path& file_;
  Walls walls_;
};

}  // namespace

Result<std::vector<Wall>> read_footprints(const fs::path& file) {
  return FootprintReader(file).read();
}

}  // namespace milepost
