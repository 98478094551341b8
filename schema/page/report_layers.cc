#include "schema/page/report_layers.h"

#include <utility>

namespace milepost {
namespace {

Json layer(const char* kind, const std::string& name, const std::string& colour, Json x, Json y) {
  Json json = {{"kind", kind}, {"colour", colour}, {"x", std::move(x)}, {"y", std::move(y)}};
  if (!name.empty()) json["name"] = name;
  return json;
}

}  // namespace

Json line_layer(const std::string& name, const std::string& colour, double width_px, Json x,
                Json y) {
  Json json = layer("line", name, colour, std::move(x), std::move(y));
  json["width_px"] = width_px;
  return json;
}

Json dots_layer(const std::string& name, const std::string& colour, double radius_px, Json x,
                Json y) {
  Json json = layer("dots", name, colour, std::move(x), std::move(y));
  json["radius_px"] = radius_px;
  return json;
}

Json circles_layer(const std::string& name, const std::string& edge, const std::string& fill,
                   double radius_px, double edge_px, Json x, Json y) {
  Json json = dots_layer(name, edge, radius_px, std::move(x), std::move(y));
  json["fill"] = fill;
  json["edge_px"] = edge_px;
  return json;
}

Json area_layer(const std::string& name, const std::string& colour, Json x, Json y) {
  return layer("area", name, colour, std::move(x), std::move(y));
}

Json texts_layer(const Json& text, const Words& words, Json x, Json y) {
  return {{"kind", "texts"},      {"text", text},
          {"align", words.align}, {"shift_px", {words.right_px, words.down_px}},
          {"x", std::move(x)},    {"y", std::move(y)}};
}

Json status_key(const std::string& status) { return {{"kind", "status"}, {"name", status}}; }

}  // namespace milepost
