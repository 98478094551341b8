#include "client/evaluate/report/report_json.h"

#include <cmath>

#include "client/evaluate/report/report_numbers.h"

namespace milepost {
namespace {

std::string frames_fact(const Drive& drive) {
  std::string text = std::to_string(drive.frames.size());
  if (drive.frames.size() > 1) {
    const double duration_s = drive.frames.back().timestamp_s - drive.frames.front().timestamp_s;
    text += " in " + number(duration_s, 1) + " s";
  }
  if (drive.camera.width_px > 0) {
    text += ", " + std::to_string(drive.camera.width_px) + " \u00D7 " +
            std::to_string(drive.camera.height_px) + " pixels";
  }
  return text;
}

}  // namespace

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

Facts facts_of(const Drive& drive) {
  return {{"Captured", drive.captured},
          {"Frames", frames_fact(drive)},
          {"Recording", drive.source},
          {"Licence", drive.licence}};
}

std::string title_of(const Drive& drive) {
  return drive.name.empty() ? "unnamed drive" : drive.name;
}

Json json_of(const PageHead& head) {
  Json facts = Json::array();
  for (const auto& [name, value] : head.facts) facts.push_back(Json::array({name, value}));
  return {{"kind", head.kind}, {"title", head.title}, {"lead", head.lead}, {"facts", facts}};
}

}  // namespace milepost
