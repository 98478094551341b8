// The segments near a position, over the whole catalog.
#include <algorithm>
#include <tuple>

#include <nlohmann/json.hpp>

#include "server/routes/answers.h"
#include "server/routes/routes.h"

namespace milepost::server {
namespace {

struct Near {
  std::shared_ptr<const MapBuild> map;
  std::string segment;
  double length_m = 0;
  LineProjection projection;
};

Result<GeoPoint> position_of(const Query& query) {
  const Result<std::string> near = query.text("near");
  if (!near) return near.error();
  const std::size_t comma = near->find(',');
  if (comma == std::string::npos) {
    return Error{ErrorCode::invalid_input, "parameter near", "is '" + *near + "'",
                 "write near=LATITUDE,LONGITUDE in degrees"};
  }
  const Result<double> latitude_deg = parse_number(near->substr(0, comma), "latitude of near");
  if (!latitude_deg) return latitude_deg.error();
  const Result<double> longitude_deg = parse_number(near->substr(comma + 1), "longitude of near");
  if (!longitude_deg) return longitude_deg.error();
  const GeoPoint position{*latitude_deg, *longitude_deg, 0};
  if (!is_valid(position)) {
    return Error{ErrorCode::invalid_input, "parameter near", "is out of range",
                 "write a latitude in [-90, 90] and a longitude in [-180, 180]"};
  }
  return position;
}

Result<double> radius_of(const Query& query) {
  const Result<double> radius_m = query.number("radius_m");
  if (!radius_m) return radius_m.error();
  if (!is_near_radius(*radius_m)) {
    return Error{ErrorCode::invalid_input, "parameter radius_m", "is out of range",
                 "write metres, more than 0 and at most 10000"};
  }
  return radius_m;
}

bool nearer(const Near& a, const Near& b) {
  return std::tie(a.projection.distance_m, a.map->map, a.segment) <
         std::tie(b.projection.distance_m, b.map->map, b.segment);
}

std::string json_of(const std::vector<Near>& found) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Near& near : found) {
    list.push_back({{"map", near.map->map},
                    {"build", near.map->build},
                    {"segment", near.segment},
                    {"along_m", near.projection.along_m},
                    {"distance_m", near.projection.distance_m},
                    {"length_m", near.length_m}});
  }
  const nlohmann::ordered_json json = {{"segments", std::move(list)}};
  return json.dump();
}

}  // namespace

Result<Response> answer_segments_near(const Call& call) {
  const Result<GeoPoint> position = position_of(call.query);
  if (!position) return position.error();
  const Result<double> radius_m = radius_of(call.query);
  if (!radius_m) return radius_m.error();
  std::vector<Near> found;
  for (const auto& map : call.catalog.near(*position, *radius_m)) {
    if (!call.grant.is_for(map->map)) continue;
    const auto lines = call.catalog.lines(*map);
    if (!lines) continue;  // one that is damaged hides no other
    for (const auto& [line, projection] : (*lines)->near(*position, *radius_m))
      found.push_back({map, line->segment, line->length_m, projection});
  }
  std::sort(found.begin(), found.end(), nearer);
  return current_json(document_of(json_of(found)));
}

}  // namespace milepost::server
