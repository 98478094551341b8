#include "schema/page/report_json.h"

#include <cmath>

namespace milepost {

Json rounded(double value, int decimals) {
  if (!std::isfinite(value)) return nullptr;
  const double scale = std::pow(10, decimals);
  const double result = std::round(value * scale) / scale;
  if (!std::isfinite(result)) return value;
  if (result == std::trunc(result) && std::abs(result) < 1e15) {
    return static_cast<std::int64_t>(result);  // "3", not "3.0"
  }
  return result;
}

Json rounded(const std::vector<double>& values, int decimals) {
  Json array = Json::array();
  for (const double value : values) array.push_back(rounded(value, decimals));
  return array;
}

Json json_of(const Figure& figure) {
  return {{"part", "figure"},
          {"heading", figure.heading},
          {"caption", figure.caption},
          {"plots", figure.plots},
          {"keys", figure.keys}};
}

Json axis(const std::string& label, double min, double max, int decimals) {
  return {
      {"label", label}, {"min", rounded(min, 6)}, {"max", rounded(max, 6)}, {"decimals", decimals}};
}

Json table_column(const std::string& heading, const std::string& unit, int decimals) {
  return {{"heading", heading}, {"unit", unit}, {"decimals", decimals}};
}

Json words_column(const std::string& heading) {
  return {{"heading", heading}, {"unit", ""}, {"decimals", nullptr}};
}

Json text_column(const std::string& heading) {
  return {{"heading", heading}, {"unit", ""}, {"decimals", 0}, {"text", true}};
}

Json json_of(const PageHead& head) {
  Json facts = Json::array();
  for (const auto& [name, value] : head.facts) facts.push_back(Json::array({name, value}));
  return {{"kind", head.kind}, {"title", head.title}, {"lead", head.lead}, {"facts", facts}};
}

}  // namespace milepost
