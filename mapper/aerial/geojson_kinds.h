// Recognizes other JSON documents than the expected GeoJSON.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace milepost {

bool is_geojson_type(std::string_view type);
// 'Polygon' for 'polygon'; none if no type matches in any case.
std::optional<std::string> geojson_type_in_other_case(std::string_view type);

struct OtherJson {
  std::string name;       // "TopoJSON"
  std::string converter;  // a command that converts it to GeoJSON
};

// The other map format of the document, if it is one.
std::optional<OtherJson> kind_of_other_json(const nlohmann::json& root);

// Whether the text has one object per line (RFC 8142, or similar without separators).
bool is_line_delimited(std::string_view text);

// Counts the geometries of a document.
class GeometryCensus {
 public:
  void count(const std::string& type) { ++geometries_[type]; }
  void count_bare_feature() { ++bare_features_; }
  // "12 Points, 3 LineStrings and no Polygon", "2 Polygons", "no features".
  std::string in_words() const;

 private:
  std::map<std::string, std::size_t> geometries_;
  std::size_t bare_features_ = 0;  // without a geometry
};

}  // namespace milepost
