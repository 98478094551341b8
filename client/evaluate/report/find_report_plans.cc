// Plans of a global localization report: the belief at several times, and the whole path.
#include <sodium.h>

#include <array>
#include <cmath>
#include <limits>

#include "client/evaluate/report/find_plan_areas.h"
#include "client/evaluate/report/find_report_figures.h"
#include "schema/page/report_layers.h"
#include "schema/page/report_numbers.h"

namespace milepost {
namespace {

constexpr PlanPoint kGap = {kNaN, kNaN};
constexpr std::size_t kMostDots = 600;

// The dots of each status on the path, in drawing order, the lowest first.
struct StatusDot {
  GlobalStatus status;
  const char* colour;
  const char* fill;
  double radius_px;
  double edge_px;
};

constexpr std::array<StatusDot, 4> kStatusDots = {{
    {GlobalStatus::initializing, "muted", "page", 2.0, 1.2},
    {GlobalStatus::lost, "page", "e5", 3.2, 0.8},
    {GlobalStatus::predicted, "m0", "page", 2.6, 1.5},
    {GlobalStatus::tracking, "page", "m0", 2.6, 0.8},
}};

// Adds points to a layer.
Json with_points(Json layer, const std::vector<PlanPoint>& points) {
  layer["x"] = easts(points);
  layer["y"] = norths(points);
  return layer;
}

Json cased(Json layer) {
  layer["cased"] = true;
  return layer;
}

Json particle_look() { return dots_layer("particle with its heading", "particle", 1.5); }
Json recorded_look() { return line_layer("recorded path so far", "m2", 2.2); }
Json here_look() { return circles_layer("recorded position", "m2", "clear", 5, 2.5); }
Json tracked_look() { return line_layer("tracked path so far", "m0", 1.8); }
Json estimate_look() {
  return circles_layer("densest mode with its heading and, while tracked, 2\u03C3", "page", "m0", 3,
                       0.8);
}

Json walls() { return line_layer("wall", "wall", 1.4, "wall_east_m", "wall_north_m"); }

// Draws a dot per particle and a stroke in the direction of its heading.
void add_particles(Json& layers, const FindSnapshot& snapshot, const PlanArea& area) {
  std::vector<PlanPoint> places;
  Json rotations_deg = Json::array();
  for (const Pose2& pose : snapshot.particles) {
    const PlanPoint place = {pose.enu_m.x(), pose.enu_m.y()};
    if (!area.contains(place)) continue;
    const Eigen::Vector2d way = direction_of(pose.heading_rad);
    places.push_back(place);
    rotations_deg.push_back(rounded(std::atan2(-way.y(), way.x()) / kRadPerDeg, 0));
  }
  Json strokes = with_points(particle_look(), places);
  strokes["marker"] = "dash";
  strokes["rotation_deg"] = rotations_deg;
  strokes["radius_px"] = 7;
  strokes["edge_px"] = 1;
  layers.push_back(strokes);
  layers.push_back(with_points(particle_look(), places));
}

// The densest mode with its heading, and while tracked a circle of two sigmas.
void add_estimate(Json& layers, const PlanPoint& at, const GlobalPoseEstimate& fix,
                  const PlanArea& area) {
  const Eigen::Vector2d way =
      0.06 * area.east.length() * direction_of(fix.heading_deg * kRadPerDeg);
  layers.push_back(cased(with_points(tracked_look(), {at, {at.x + way.x(), at.y + way.y()}})));
  if (is_tracked(fix.status) && std::isfinite(at.x)) {
    Json circle = cased(tracked_look());
    circle["at"] = {rounded(at.x, 3), rounded(at.y, 3)};
    circle["radius_m"] = rounded(2 * fix.sigma_m, 3);
    layers.push_back(circle);
  }
  layers.push_back(with_points(estimate_look(), {at}));
}

std::vector<PlanPoint> until(const std::vector<PlanPoint>& path, std::size_t frame) {
  return {path.begin(), path.begin() + static_cast<std::ptrdiff_t>(frame) + 1};
}

// The tracked path, with gaps where the vehicle was not tracked.
std::vector<PlanPoint> tracked_path(const FoundSeries& series) {
  std::vector<PlanPoint> path = series.found;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!is_tracked((*series.input->frames)[i].fix.status)) path[i] = kGap;
  }
  return path;
}

std::string time_text(double time_s) { return number(time_s, 1) + " s"; }

std::string moment_of(const FoundSeries& series, std::size_t frame) {
  if (series.summary.found_frame == frame) return "found";
  if (frame == 0) return "start";
  if (frame + 1 == series.time_s.size()) return "end";
  return name_of((*series.input->frames)[frame].fix.status);
}

std::string snapshot_caption(const FoundSeries& series, std::size_t frame, bool is_close_up) {
  const GlobalPoseEstimate& fix = (*series.input->frames)[frame].fix;
  const double error_m = series.errors[frame].position_m;
  std::string text = std::string(is_close_up ? "Close-up" : "The whole area") + "; status " +
                     name_of(fix.status) + ", \u03C3 " + metres(fix.sigma_m) + ", " +
                     number(100 * fix.mode_probability, 0) +
                     "\u00A0% of the belief in the densest mode.";
  if (std::isfinite(error_m)) text += " Off by " + metres(error_m) + ".";
  return text;
}

Figure snapshot_figure(const FoundSeries& series, std::size_t number) {
  const FindSnapshot& snapshot = series.snapshots[number];
  const std::size_t frame = snapshot.frame;
  const std::optional<PlanArea> close_up = close_up_area(series, snapshot);
  const PlanArea area = close_up.value_or(whole_area(series));
  Figure figure;
  figure.heading = std::to_string(number + 1) + "\u2002" + time_text(series.time_s[frame]) + ": " +
                   moment_of(series, frame);
  figure.caption = snapshot_caption(series, frame, close_up.has_value());
  Json plot = plan_plot(area, "Walls, particles, paths and estimate: " + figure.heading);
  plot["legend"] = false;
  Json& layers = plot["layers"];
  layers.push_back(walls());
  add_particles(layers, snapshot, area);
  layers.push_back(cased(with_points(recorded_look(), until(series.recorded, frame))));
  layers.push_back(cased(with_points(tracked_look(), until(tracked_path(series), frame))));
  layers.push_back(with_points(here_look(), {series.recorded[frame]}));
  add_estimate(layers, series.found[frame], (*series.input->frames)[frame].fix, area);
  figure.plots.push_back(plot);
  return figure;
}

std::size_t dot_stride(const FoundSeries& series) { return series.found.size() / kMostDots + 1; }

void add_found(Json& layers, const FoundSeries& series) {
  const std::size_t stride = dot_stride(series);
  for (const StatusDot& dot : kStatusDots) {
    std::vector<PlanPoint> points;
    for (std::size_t i = 0; i < series.found.size(); i += stride) {
      if ((*series.input->frames)[i].fix.status == dot.status) points.push_back(series.found[i]);
    }
    layers.push_back(with_points(
        circles_layer(name_of(dot.status), dot.colour, dot.fill, dot.radius_px, dot.edge_px),
        points));
  }
}

void add_snapshot_numbers(Json& layers, const FoundSeries& series) {
  std::vector<PlanPoint> places;
  Json numbers = Json::array();
  for (std::size_t k = 0; k < series.snapshots.size(); ++k) {
    places.push_back(series.recorded[series.snapshots[k].frame]);
    numbers.push_back(std::to_string(k + 1));
  }
  layers.push_back(with_points(circles_layer("snapshot", "m2", "clear", 5, 2.5), places));
  layers.push_back(texts_layer(numbers, {"left", 9, -6}, easts(places), norths(places)));
}

std::string base64_of(ByteView bytes) {
  std::string text(sodium_base64_ENCODED_LEN(bytes.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(),
                    sodium_base64_VARIANT_ORIGINAL);
  text.pop_back();  // the terminating zero
  return text;
}

// The image as an affine transformation to metres: its two sides, to the right and downwards, and
// its origin, each as east and north. Exact enough within the extent of a plan.
Json json_of(const PagePicture& picture, const LocalFrame& frame) {
  const PlanPoint origin = on_plan(frame, picture.top_left);
  const PlanPoint right = on_plan(frame, picture.top_right);
  const PlanPoint down = on_plan(frame, picture.bottom_left);
  return {{"east_north_m", rounded({right.x - origin.x, right.y - origin.y, down.x - origin.x,
                                    down.y - origin.y, origin.x, origin.y},
                                   3)},
          {"href", "data:image/jpeg;base64," + base64_of(picture.jpeg)}};
}

}  // namespace

Json plan_keys() {
  return {walls(), particle_look(), recorded_look(), here_look(), tracked_look(), estimate_look()};
}

std::vector<Figure> snapshot_figures(const FoundSeries& series) {
  std::vector<Figure> figures;
  for (std::size_t k = 0; k < series.snapshots.size(); ++k) {
    figures.push_back(snapshot_figure(series, k));
  }
  return figures;
}

Figure path_figure(const FoundSeries& series) {
  Figure figure;
  figure.heading = "The whole path";
  const std::size_t stride = dot_stride(series);
  figure.caption =
      "Metres east and north, to scale. Each dot is the densest mode of a frame" +
      (stride > 1 ? ", one of " + std::to_string(stride) + " frames" : std::string()) +
      "; the line is the recorded path. Until the vehicle is found the densest mode jumps. The "
      "numbers are those of the snapshots.";
  Json plot = plan_plot(path_area(series), "The recorded path and the estimates in plan view");
  Json& layers = plot["layers"];
  layers.push_back(walls());
  Json recorded = cased(line_layer("recorded path", "m2", 2.2, "east_m", "north_m"));
  layers.push_back(recorded);
  add_found(layers, series);
  add_snapshot_numbers(layers, series);
  figure.plots.push_back(plot);
  return figure;
}

void add_ground(Json& page, const FoundSeries& series) {
  std::vector<PlanPoint> corners;
  for (const PlanWall& wall : series.input->recorder->walls()) {
    corners.insert(corners.end(),
                   {{wall.begin_m.x(), wall.begin_m.y()}, {wall.end_m.x(), wall.end_m.y()}, kGap});
  }
  page["columns"]["wall_east_m"] = easts(corners);
  page["columns"]["wall_north_m"] = norths(corners);
  if (!series.input->backdrop) return;
  const std::optional<PagePicture> picture =
      page_picture(*series.input->backdrop, shown_bounds(series));
  if (!picture) return;
  page["ground"]["picture"] = json_of(*picture, LocalFrame(series.input->recorder->origin()));
}

}  // namespace milepost
