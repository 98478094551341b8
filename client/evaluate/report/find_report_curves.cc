// Curves of a global localization report: errors and belief over time.
#include <algorithm>
#include <array>
#include <cmath>

#include "client/evaluate/report/find_report_figures.h"
#include "client/evaluate/statistics.h"
#include "schema/page/report_layers.h"
#include "schema/page/report_numbers.h"

namespace milepost {
namespace {

constexpr std::array<GlobalStatus, 4> kStatuses = {GlobalStatus::initializing,
                                                   GlobalStatus::tracking, GlobalStatus::predicted,
                                                   GlobalStatus::lost};
constexpr double kLeastError = 0.1;  // lower end of the axis, in metres or degrees

// A plot over frames without layers, with the status of each frame.
Json time_plot(const FoundSeries& series, const std::string& description, int height_px, Json y) {
  Json marks = Json::array();
  const std::vector<FoundFrame>& frames = *series.input->frames;
  for (std::size_t first = 0; first < frames.size();) {
    const GlobalStatus status = frames[first].fix.status;
    std::size_t end = first;
    while (end < frames.size() && frames[end].fix.status == status) ++end;
    const double to_s = series.time_s[std::min(end, frames.size() - 1)];
    marks.push_back({rounded(series.time_s[first], 3), rounded(to_s, 3), name_of(status)});
    first = end;
  }
  const double end_s = series.time_s.back() > 0 ? series.time_s.back() : 1;
  return {{"frames", true},         {"description", description},
          {"height_px", height_px}, {"x", axis("time (s)", 0, end_s)},
          {"y", std::move(y)},      {"lanes", Json::array({{{"marks", marks}}})},
          {"layers", Json::array()}};
}

void add_found_line(Json& plot, const FoundSeries& series) {
  if (!series.summary.found_frame) return;
  const Json at_s = rounded(series.time_s[*series.summary.found_frame], 3);
  const Json top = plot["y"]["max"];
  Json line = line_layer("", "ink", 1, {at_s, at_s}, {plot["y"]["min"], top});
  line["dash"] = {3, 3};
  plot["layers"].push_back(line);
  plot["layers"].push_back(texts_layer(Json::array({"found"}), {"left", 5, 13}, Json::array({at_s}),
                                       Json::array({top})));
}

// A logarithmic axis between the powers of ten around the values.
Json error_axis(const std::string& label, const std::vector<double>& values) {
  double low = 1;
  double high = 1;
  for (const double value : finite_only(values)) {
    low = std::min(low, std::max(kLeastError, value));
    high = std::max(high, value);
  }
  low = std::pow(10, std::floor(std::log10(low)));
  high = std::pow(10, std::ceil(std::log10(high)));
  Json json = axis(label, low, high > low ? high : 10 * low);
  json["log"] = true;
  return json;
}

// Values below the axis are drawn at its edge.
Json on_axis(std::vector<double> values, const Json& y) {
  const double least = y["min"];
  for (double& value : values) {
    if (!std::isnan(value)) value = std::max(least, value);
  }
  return rounded(values, 3);
}

Figure error_figure(const FoundSeries& series, const std::string& heading, const std::string& label,
                    int height_px, const std::vector<double>& errors,
                    const std::vector<double>& two_sigmas) {
  Figure figure;
  figure.heading = heading;
  if (finite_only(errors).empty()) return figure;
  std::vector<double> all = errors;
  all.insert(all.end(), two_sigmas.begin(), two_sigmas.end());
  Json plot = time_plot(series, heading, height_px, error_axis(label, all));
  plot["layers"].push_back(
      area_layer("up to 2\u03C3 as reported", "band", "time_s", on_axis(two_sigmas, plot["y"])));
  plot["layers"].push_back(line_layer("error", "m0", 1.8, "time_s", on_axis(errors, plot["y"])));
  add_found_line(plot, series);
  figure.plots.push_back(plot);
  for (const GlobalStatus status : kStatuses) figure.keys.push_back(status_key(name_of(status)));
  return figure;
}

template <class Value>
std::vector<double> values_of(const FoundSeries& series, const Value& value) {
  std::vector<double> values;
  for (const FoundFrame& frame : *series.input->frames) values.push_back(value(frame.fix));
  return values;
}

Json value(const char* label, const char* column, const char* unit, int decimals,
           bool is_signed = false) {
  return {{"label", label},
          {"column", column},
          {"unit", unit},
          {"decimals", decimals},
          {"signed", is_signed}};
}

Json statuses_of(const FoundSeries& series) {
  Json statuses = Json::array();
  for (const FoundFrame& frame : *series.input->frames) {
    statuses.push_back(std::find(kStatuses.begin(), kStatuses.end(), frame.fix.status) -
                       kStatuses.begin());
  }
  return statuses;
}

Json frame_values() {
  Json words = Json::array();
  for (const GlobalStatus status : kStatuses) words.push_back(name_of(status));
  return Json::array({{{"label", "status"}, {"column", "status"}, {"words", words}},
                      value("position error", "error_m", "m", 2),
                      value("\u03C3", "sigma_m", "m", 2),
                      value("heading error", "heading_error_deg", "\u00B0", 1, true),
                      value("\u03C3", "heading_sigma_deg", "\u00B0", 1),
                      value("mode probability", "mode_probability", "", 2),
                      value("inlier ratio", "inlier_ratio", "", 2)});
}

}  // namespace

Figure position_error_figure(const FoundSeries& series) {
  std::vector<double> errors;
  for (const FindError& error : series.errors) errors.push_back(error.position_m);
  Figure figure = error_figure(
      series, "Position error over time", "error (m)", 260, errors,
      values_of(series, [](const GlobalPoseEstimate& fix) { return 2 * fix.sigma_m; }));
  figure.caption =
      "Distance from the recorded position, on a logarithmic scale that shows both the search and "
      "the tracking. In the grey band the error is within twice the reported \u03C3; until the "
      "vehicle is found this is the \u03C3 of the whole belief. The lane under the axis shows the "
      "status of each frame.";
  return figure;
}

Figure heading_error_figure(const FoundSeries& series) {
  std::vector<double> errors;
  for (const FindError& error : series.errors) errors.push_back(std::abs(error.heading_deg));
  Figure figure = error_figure(
      series, "Heading error over time", "error (\u00B0)", 180, errors,
      values_of(series, [](const GlobalPoseEstimate& fix) { return 2 * fix.heading_sigma_deg; }));
  figure.caption =
      "Absolute angle to the recorded heading; \u03C3 is that of the most probable mode.";
  return figure;
}

Figure belief_figure(const FoundSeries& series) {
  Figure figure;
  figure.heading = "Mode probability and inlier ratio";
  figure.caption =
      "Mode probability: the part of the belief in its densest mode. Inlier ratio: the share of "
      "recent measurements that the walls explain at this mode. The vehicle counts as found when "
      "both are high over some distance, and as lost when one of them becomes low.";
  Json plot = time_plot(series, figure.heading, 160, axis("share", 0, 1));
  plot["layers"].push_back(line_layer("inlier ratio", "m1", 1.1, "time_s", "inlier_ratio"));
  plot["layers"].push_back(line_layer("mode probability", "m0", 1.8, "time_s", "mode_probability"));
  add_found_line(plot, series);
  figure.plots.push_back(plot);
  for (const GlobalStatus status : kStatuses) figure.keys.push_back(status_key(name_of(status)));
  return figure;
}

void add_frames(Json& page, const FoundSeries& series) {
  Json names = Json::array();
  for (const FoundFrame& frame : *series.input->frames) names.push_back(frame.filename);
  std::vector<double> errors_m;
  std::vector<double> turns_deg;
  for (const FindError& error : series.errors) {
    errors_m.push_back(error.position_m);
    turns_deg.push_back(error.heading_deg);
  }
  const auto column = [&](double (*value)(const GlobalPoseEstimate&), int decimals) {
    return rounded(values_of(series, value), decimals);
  };
  page["columns"] = {
      {"time_s", rounded(series.time_s, 3)},
      {"frame", names},
      {"east_m", easts(series.recorded)},
      {"north_m", norths(series.recorded)},
      {"status", statuses_of(series)},
      {"error_m", rounded(errors_m, 3)},
      {"sigma_m", column([](const GlobalPoseEstimate& fix) { return fix.sigma_m; }, 3)},
      {"heading_error_deg", rounded(turns_deg, 2)},
      {"heading_sigma_deg",
       column([](const GlobalPoseEstimate& fix) { return fix.heading_sigma_deg; }, 2)},
      {"mode_probability",
       column([](const GlobalPoseEstimate& fix) { return fix.mode_probability; }, 3)},
      {"inlier_ratio", column([](const GlobalPoseEstimate& fix) { return fix.inlier_ratio; }, 3)}};
  page["frames"] = {
      {"x", "time_s"},
      {"names", "frame"},
      {"east", "east_m"},
      {"north", "north_m"},
      {"label", "time"},
      {"unit", "s"},
      {"decimals", 1},
      {"rows", Json::array({{{"name", "found"}, {"colour", "m0"}, {"values", frame_values()}}})}};
}

}  // namespace milepost
