#include "mapper/aerial/geojson_kinds.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

namespace milepost {
namespace {

constexpr std::array<std::string_view, 9> kTypes = {
    "FeatureCollection", "Feature", "GeometryCollection", "Polygon", "MultiPolygon", "LineString",
    "MultiPoint",        "Point",   "MultiLineString"};

bool is_same_in_any_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

std::string counted(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

// "a, b and c"
std::string listed(const std::vector<std::string>& parts) {
  std::string text = parts.front();
  for (std::size_t i = 1; i < parts.size(); ++i) {
    text += (i + 1 < parts.size() ? ", " : " and ") + parts[i];
  }
  return text;
}

}  // namespace

bool is_geojson_type(std::string_view type) {
  return std::ranges::find(kTypes, type) != kTypes.end();
}

std::optional<std::string> geojson_type_in_other_case(std::string_view type) {
  for (const std::string_view known : kTypes) {
    if (is_same_in_any_case(type, known)) return std::string(known);
  }
  return std::nullopt;
}

std::optional<OtherJson> kind_of_other_json(const nlohmann::json& root) {
  if (!root.is_object()) return std::nullopt;
  const auto type = root.find("type");
  if (type != root.end()) {
    if (*type == "Topology") return OtherJson{"TopoJSON", "ogr2ogr -f GeoJSON NEW.geojson OLD"};
    return std::nullopt;
  }
  if (root.contains("elements"))
    return OtherJson{"Overpass JSON", "osmtogeojson OLD > NEW.geojson"};
  if (root.contains("features") && root.contains("geometryType")) {
    return OtherJson{"Esri JSON", "ogr2ogr -f GeoJSON NEW.geojson OLD"};
  }
  return std::nullopt;
}

bool is_line_delimited(std::string_view text) {
  constexpr char kRecordSeparator = '\x1e';
  constexpr std::string_view kSpace = " \t\r\n\x1e";
  if (text.starts_with(kRecordSeparator)) return true;
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return false;
  const std::size_t last = text.find_last_not_of(kSpace, end);
  const std::size_t next = text.find_first_not_of(kSpace, end);
  return last != std::string_view::npos && next != std::string_view::npos && text.front() == '{' &&
         text[last] == '}' && text[next] == '{';
}

std::string GeometryCensus::in_words() const {
  std::vector<std::string> parts;
  for (const auto& [type, count] : geometries_) parts.push_back(counted(count, type));
  if (bare_features_ > 0) {
    parts.push_back(counted(bare_features_, "feature") + " without a geometry");
  }
  if (parts.empty()) return "no features";
  const bool has_polygons = geometries_.contains("Polygon") || geometries_.contains("MultiPolygon");
  if (!has_polygons) parts.emplace_back("no Polygon");
  return listed(parts);
}

}  // namespace milepost
