#include "client/evaluate/report/plot/chart.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "client/evaluate/report/plot/text.h"

namespace milepost::plot {
namespace {

// The canvas is stretched to the plot, so its unit is a share of the width or height. Whole numbers
// of it are finer than a pixel and shorter than decimals.
constexpr int kCanvas = 10000;
constexpr int kLaneHeightPx = 9;
constexpr int kLanesTopPx = 5;  // keeps them clear of the lowest tick label
constexpr int kTickLabelPx = 16;
constexpr int kBelowTicksPx = 26;  // for the axis's label

bool is_drawable(const Point& point) { return std::isfinite(point.x) && std::isfinite(point.y); }

// Far outside the plot it no longer matters where exactly.
long canvas_units(double share) { return std::lround(std::clamp(share, -1.0, 2.0) * kCanvas); }

std::string whole(long value) { return std::to_string(value); }

std::string title(const std::string& text) {
  return text.empty() ? "" : "<title>" + escaped(text) + "</title>";
}

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + R"(=")" + value + R"(")";
}

std::string translation(double right_px, double down_px) {
  return "translate(" + whole(std::lround(right_px)) + " " + whole(std::lround(down_px)) + ")";
}

// The stretches of points without a gap.
std::vector<std::vector<Point>> unbroken(const std::vector<Point>& points) {
  std::vector<std::vector<Point>> runs(1);
  for (const Point& point : points) {
    if (is_drawable(point)) {
      runs.back().push_back(point);
    } else if (!runs.back().empty()) {
      runs.emplace_back();
    }
  }
  if (runs.back().empty()) runs.pop_back();
  return runs;
}

}  // namespace

Chart Chart::of_height(Axis x, Axis y, int height_px, std::string description) {
  return {std::move(x), std::move(y), "chart", "height:" + whole(height_px) + "px",
          std::move(description)};
}

Chart Chart::of_equal_units(Axis x, Axis y, std::string description) {
  const double height_share = (y.to() - y.from()) / (x.to() - x.from());
  const std::string shape = "aspect-ratio:" + whole(kCanvas) + "/" +
                            whole(std::max(1L, std::lround(height_share * kCanvas)));
  return {std::move(x), std::move(y), "chart plan", shape, std::move(description)};
}

Chart::Chart(Axis x, Axis y, std::string css_class, std::string shape_css, std::string description)
    : x_(std::move(x)),
      y_(std::move(y)),
      css_class_(std::move(css_class)),
      shape_css_(std::move(shape_css)),
      description_(std::move(description)) {}

std::string Chart::to_canvas(const Point& point) const {
  return whole(canvas_units(x_.share(point.x))) + " " + whole(canvas_units(1 - y_.share(point.y)));
}

std::string Chart::path(const std::vector<Point>& points) const {
  std::string data = "M" + to_canvas(points.front());
  // A point alone is a line too short to see, which round ends turn into a dot.
  if (points.size() == 1) return data + "h1";
  data += "L";
  for (std::size_t i = 1; i < points.size(); ++i) data += (i > 1 ? " " : "") + to_canvas(points[i]);
  return data;
}

void Chart::add_path(const std::string& data, const std::string& css_class) {
  if (data.empty()) return;
  canvas_ += "<path" + attribute("class", css_class) + attribute("d", data) + "/>\n";
}

void Chart::line(const std::vector<Point>& points, const std::string& css_class) {
  std::string data;
  for (const auto& run : unbroken(points)) data += path(run);
  add_path(data, css_class);
}

void Chart::dots(const std::vector<Point>& points, const std::string& css_class) {
  std::string data;
  for (const Point& point : points) {
    if (is_drawable(point) && y_.contains(point.y)) data += path({point});
  }
  add_path(data, css_class);
}

void Chart::band(const std::vector<Point>& points, const std::string& css_class) {
  std::string data;
  for (auto run : unbroken(points)) {
    for (std::size_t i = run.size(); i-- > 0;) run.push_back({run[i].x, -run[i].y});
    data += path(run) + "z";
  }
  add_path(data, css_class);
}

void Chart::area(const std::vector<Point>& points, const std::string& css_class) {
  std::string data;
  for (auto run : unbroken(points)) {
    run.insert(run.begin(), {run.front().x, 0});
    run.push_back({run.back().x, 0});
    data += path(run) + "z";
  }
  add_path(data, css_class);
}

void Chart::arrows_beyond(const std::vector<Point>& points, const std::string& css_class) {
  for (const Point& point : points) {
    if (!is_drawable(point) || y_.contains(point.y)) continue;
    const bool above = point.y > y_.to();
    overlay_ += std::string("<use") + attribute("href", above ? "#up" : "#down") +
                attribute("class", css_class) + attribute("x", percent(x_.share(point.x))) +
                attribute("y", above ? "0" : "100%") + "/>\n";
  }
}

void Chart::shared(const std::string& id) {
  const double width = x_.share(1) - x_.share(0);
  const double height = y_.share(1) - y_.share(0);
  canvas_ += "<use" + attribute("href", "#" + id) +
             attribute("transform", "matrix(" + coordinate(width * kCanvas, 6) + " 0 0 " +
                                        coordinate(height * kCanvas, 6) + " " +
                                        coordinate(x_.share(0) * kCanvas, 6) + " " +
                                        coordinate((1 - y_.share(0)) * kCanvas, 6) + ")") +
             "/>\n";
}

void Chart::circle(const Point& at, double radius_px, const std::string& css_class,
                   const std::string& text) {
  if (!x_.contains(at.x) || !y_.contains(at.y)) return;
  overlay_ += "<circle" + attribute("class", css_class) + attribute("r", number(radius_px, 1)) +
              attribute("cx", percent(x_.share(at.x))) +
              attribute("cy", percent(1 - y_.share(at.y))) + ">" + title(text) + "</circle>\n";
}

void Chart::symbol(const Point& at, double right_px, double down_px, const std::string& css_class,
                   const std::string& id) {
  if (!is_drawable(at)) return;
  overlay_ += "<use" + attribute("href", "#" + id) + attribute("class", css_class) +
              attribute("x", percent(x_.share(at.x))) +
              attribute("y", percent(1 - y_.share(at.y))) +
              attribute("transform", translation(right_px, down_px)) + "/>\n";
}

void Chart::word(const Point& at, double right_px, double down_px, const std::string& css_class,
                 const std::string& text) {
  if (!is_drawable(at)) return;
  overlay_ += "<text" + attribute("class", css_class) + attribute("x", percent(x_.share(at.x))) +
              attribute("y", percent(1 - y_.share(at.y))) +
              attribute("transform", translation(right_px, down_px)) + ">" + escaped(text) +
              "</text>\n";
}

void Chart::level(double y, const std::string& css_class, const std::string& name) {
  if (!y_.contains(y)) return;
  const std::string at = percent(1 - y_.share(y));
  overlay_ += "<line" + attribute("class", css_class) + attribute("x1", "0") +
              attribute("x2", "100%") + attribute("y1", at) + attribute("y2", at) + "/>\n";
  if (!name.empty()) word({x_.to(), y}, -4, 14, "end", name);
}

void Chart::hover(const std::vector<HoverStrip>& strips) {
  for (const HoverStrip& strip : strips) {
    if (!std::isfinite(strip.from_x) || !std::isfinite(strip.to_x)) continue;
    const long from = canvas_units(x_.share(strip.from_x));
    const long to = canvas_units(x_.share(strip.to_x));
    hover_ += "<rect" + attribute("x", whole(from)) +
              attribute("width", whole(std::max(1L, to - from))) +
              attribute("height", whole(kCanvas)) + ">" + title(strip.text) + "</rect>\n";
  }
}

void Chart::add_lane(const std::string& css_class) {
  ++lanes_count_;
  if (css_class.empty()) return;
  lane_heads_ += "<circle" + attribute("class", css_class) + attribute("cx", "-10") +
                 attribute("cy", whole(kLanesTopPx + kLaneHeightPx * lanes_count_)) +
                 attribute("r", "3") + "/>\n";
}

void Chart::mark_lane(double from_x, double to_x, const std::string& css_class,
                      const std::string& text) {
  if (!std::isfinite(from_x) || !std::isfinite(to_x)) return;
  const long from = canvas_units(x_.share(std::min(from_x, to_x)));
  const long to = canvas_units(x_.share(std::max(from_x, to_x)));
  lane_marks_ +=
      "<path" + attribute("class", css_class) +
      attribute("d", "M" + whole(from) + " " + whole(kLanesTopPx + kLaneHeightPx * lanes_count_) +
                         "H" + whole(std::max(to, from + 1))) +
      ">" + title(text) + "</path>\n";
}

std::string Chart::frame() const {
  std::string grid;
  for (const double value : y_.ticks().values) {
    const std::string at = percent(1 - y_.share(value));
    grid += "<line" + attribute("class", value == 0 ? "zero" : "grid") + attribute("x2", "100%") +
            attribute("y1", at) + attribute("y2", at) + "/>\n";
  }
  for (const double value : x_.ticks().values) {
    const std::string at = percent(x_.share(value));
    grid += "<line" + attribute("class", value == 0 ? "zero" : "grid") + attribute("y2", "100%") +
            attribute("x1", at) + attribute("x2", at) + "/>\n";
  }
  return grid;
}

int Chart::tick_labels_px() const {
  const int lanes_px = lanes_count_ > 0 ? kLanesTopPx + kLaneHeightPx * lanes_count_ + 4 : 0;
  return lanes_px + kTickLabelPx;
}

std::string Chart::tick_labels() const {
  const int below_px = tick_labels_px();
  std::string labels;
  for (const double value : y_.ticks().values) {
    labels += R"(<text class="end" x="-8" dy=".35em")" +
              attribute("y", percent(1 - y_.share(value))) + ">" + y_.tick_text(value) +
              "</text>\n";
  }
  for (const double value : x_.ticks().values) {
    labels += R"(<text class="mid" y="100%")" + attribute("dy", whole(below_px)) +
              attribute("x", percent(x_.share(value))) + ">" + x_.tick_text(value) + "</text>\n";
  }
  labels += R"(<text class="mid name" x="50%" y="100%")" + attribute("dy", whole(below_px + 20)) +
            ">" + escaped(x_.label()) + "</text>\n";
  labels += R"(<text class="name" x="-48" y="-10">)" + escaped(y_.label()) + "</text>\n";
  return labels;
}

std::string Chart::lanes() const {
  if (lanes_count_ == 0) return "";
  const std::string height = whole(kLanesTopPx + kLaneHeightPx * (lanes_count_ + 1));
  return R"(<svg class="open" y="100%")" + attribute("height", height) + ">" + lane_heads_ +
         "</svg>\n<svg class=\"open\" y=\"100%\" width=\"100%\"" + attribute("height", height) +
         attribute("viewBox", "0 0 " + whole(kCanvas) + " " + height) +
         R"( preserveAspectRatio="none">)" + lane_marks_ + "</svg>\n";
}

std::string Chart::svg() const {
  const std::string canvas = R"(<svg width="100%" height="100%")" +
                             attribute("viewBox", "0 0 " + whole(kCanvas) + " " + whole(kCanvas)) +
                             R"( preserveAspectRatio="none">)";
  const std::string style =
      shape_css_ + ";margin-bottom:" + whole(tick_labels_px() + kBelowTicksPx) + "px";
  std::string out = R"(<svg role="img")" + attribute("class", css_class_) +
                    attribute("style", style) + attribute("aria-label", escaped(description_)) +
                    ">\n";
  out += frame() + tick_labels();
  out += canvas + "\n" + canvas_ + "</svg>\n" + lanes();
  if (!hover_.empty()) {
    // Circles have words of their own and lie above.
    out += canvas.substr(0, canvas.size() - 1) + " class=\"hover\">\n" + hover_ + "</svg>\n";
  }
  return out + overlay_ + "</svg>\n";
}

std::string Chart::definitions() {
  return R"(<svg class="defs" aria-hidden="true"><defs><path id="up" d="M0 1l-4 7h8z"/>)"
         "<path id=\"down\" d=\"M0 -1l-4 -7h8z\"/>"
         "<path id=\"north\" d=\"M0 0V-30M-5 -22L0 -30L5 -22\"/></defs></svg>\n";
}

}  // namespace milepost::plot
