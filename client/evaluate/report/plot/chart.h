// A chart as inline SVG that keeps its letters and lines at their size however wide it is shown.
#pragma once

#include <string>
#include <vector>

#include "client/evaluate/report/plot/axis.h"

namespace milepost::plot {

// In the units of the axes. A point with a coordinate that is not finite is not drawn, and breaks a
// line in two.
struct Point {
  double x = 0;
  double y = 0;
};

// An upright slice of the plot that shows `text` while the pointer rests on it.
struct HoverStrip {
  double from_x = 0;
  double to_x = 0;
  std::string text;
};

// The drawing area fills the width it is given; positions inside are shares of it, so a style sheet
// must leave room around the element (class "chart", with equal units "chart plan") for labels.
// Later drawings lie above earlier ones. `css_class` is the caller's own word and goes in as it is;
// all other text is escaped.
class Chart {
 public:
  // As high as that, at any width.
  static Chart of_height(Axis x, Axis y, int height_px, std::string description);
  // As high as makes a unit of the one axis as long as a unit of the other.
  static Chart of_equal_units(Axis x, Axis y, std::string description);

  void line(const std::vector<Point>& points, const std::string& css_class);
  void dots(const std::vector<Point>& points, const std::string& css_class);
  // The area between y and -y.
  void band(const std::vector<Point>& points, const std::string& css_class);
  // The area between the line and y = 0.
  void area(const std::vector<Point>& points, const std::string& css_class);
  // An arrow at the edge for each point above or below the y axis's range.
  void arrows_beyond(const std::vector<Point>& points, const std::string& css_class);
  // The element of the document with that id, drawn in the units of the axes, but with y downwards
  // from 0. REQUIRES: the axes are not logarithmic.
  void shared(const std::string& id);
  // A circle that shows `text` while the pointer rests on it; none outside the plot.
  void circle(const Point& at, double radius_px, const std::string& css_class,
              const std::string& text);
  // A drawing of definitions(), by its id, with its own origin at the point moved by so many
  // pixels.
  void symbol(const Point& at, double right_px, double down_px, const std::string& css_class,
              const std::string& id);
  // A word right of a point, or above or left of it, moved by so many pixels.
  void word(const Point& at, double right_px, double down_px, const std::string& css_class,
            const std::string& text);
  // A line over the whole width at a value, with its name at the right end.
  void level(double y, const std::string& css_class, const std::string& name);
  void hover(const std::vector<HoverStrip>& strips);

  // Begins a lane below the x axis, marked at its left with the class; with none, not marked.
  void add_lane(const std::string& css_class);
  // Marks a stretch of the newest lane. REQUIRES: add_lane() was called.
  void mark_lane(double from_x, double to_x, const std::string& css_class, const std::string& text);

  // The svg element.
  std::string svg() const;

  // What arrows_beyond() and symbol() refer to, once in a document: "up" and "down", arrow heads
  // whose tip is the origin; "north", an arrow of 30 pixels above its origin.
  static std::string definitions();

 private:
  Chart(Axis x, Axis y, std::string css_class, std::string shape_css, std::string description);

  std::string to_canvas(const Point& point) const;
  std::string path(const std::vector<Point>& points) const;
  void add_path(const std::string& data, const std::string& css_class);
  std::string frame() const;
  int tick_labels_px() const;  // from the x axis down to their base line
  std::string tick_labels() const;
  std::string lanes() const;

  Axis x_;
  Axis y_;
  std::string css_class_;
  std::string shape_css_;
  std::string description_;
  std::string canvas_;   // inside the stretched coordinates
  std::string overlay_;  // placed by shares of the plot, in pixels otherwise
  std::string hover_;
  std::string lane_heads_;
  std::string lane_marks_;
  int lanes_count_ = 0;
};

}  // namespace milepost::plot
