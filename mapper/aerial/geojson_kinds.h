// What a JSON document may be instead of the GeoJSON that was asked for.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace milepost {

bool is_geojson_type(std::string_view type);
// 'Polygon' of 'polygon'; none where no type is written so in any case.
std::optional<std::string> geojson_type_in_other_case(std::string_view type);

struct OtherJson {
  std::string name;       // "TopoJSON"
  std::string converter;  // a command that makes GeoJSON of it
};

// The other format of maps that the document is in, where it is one.
std::optional<OtherJson> kind_of_other_json(const nlohmann::json& root);

// Whether the text has an object a line (RFC 8142 and its kin without separators).
bool is_line_delimited(std::string_view text);

// Counts what was met in a document.
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
