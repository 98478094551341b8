#include "server/publish/static_catalog.h"

#include "schema/base/json.h"
#include "schema/geo/near.h"

namespace milepost::server {

std::string static_maps_document(const std::string& maps_document) {
  nlohmann::ordered_json document = nlohmann::ordered_json::parse(maps_document);
  document["static"] = true;
  return document.dump();
}

std::string static_segments_document(const std::vector<PlacedSegment>& segments) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const PlacedSegment& placed : segments) {
    list.push_back({{"map", placed.map},
                    {"build", placed.build},
                    {"segment", placed.segment},
                    {"bounds",
                     {{"west_deg", placed.bounds.west_deg},
                      {"south_deg", placed.bounds.south_deg},
                      {"east_deg", placed.bounds.east_deg},
                      {"north_deg", placed.bounds.north_deg}}}});
  }
  const nlohmann::ordered_json document = {{"segments", std::move(list)}, {"static", true}};
  return document.dump();
}

Result<Bounds> bounds_of_segment(const std::string& segment_document, const std::string& where) {
  const nlohmann::json document = nlohmann::json::parse(segment_document);
  std::vector<GeoPoint> points;
  for (const nlohmann::json& vertex : document.at("line")) {
    points.push_back({vertex.at(0).get<double>(), vertex.at(1).get<double>(), 0});
  }
  if (!points.empty()) return bounds_around(points);
  return Error{ErrorCode::corrupt, where, "the segment has no line", "rebuild the map"};
}

}  // namespace milepost::server
