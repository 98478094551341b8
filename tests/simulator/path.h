// A smooth plane curve: straights joined by arcs, parametrized by arc length.
#pragma once

#include <vector>

#include <opencv2/core.hpp>

namespace milepost::simulator {

// Frenet coordinates: arc length from a path's start, and lateral offset to the right of it.
struct RoadPlace {
  double along_m = 0;
  double lateral_m = 0;
};

// A vertex of a path, and the radius of the arc that rounds it.
struct Bend {
  cv::Vec2d at;  // east, north
  double radius_m = 0;
};

// A place with a direction, clockwise from north.
struct Directed {
  cv::Vec2d at;
  double heading_rad = 0;
};

// A unit vector of a heading, clockwise from north, and the one to its right.
cv::Vec2d forward_of(double heading_rad);
cv::Vec2d right_of(double heading_rad);

class Path {
 public:
  // From the first bend to the last by straights that are tangent to the arcs between them.
  // REQUIRES: at least two bends; the arcs fit on the straights.
  static Path through(const std::vector<Bend>& bends);
  static Path arc(const Directed& from, double length_m, double curvature_per_m);
  // Once around, counter-clockwise, from the circle's easternmost point.
  static Path circle(const cv::Vec2d& centre, double radius_m);
  // From one place to another, in the direction of each, by two arcs.
  // REQUIRES: the places differ.
  static Path joining(const Directed& from, const Directed& to);
  // One after the other. REQUIRES: at least one; each begins where the one before ends.
  static Path chain(const std::vector<Path>& paths);
  // The same line from its end to its start.
  Path reversed() const;
  // The line at a constant lateral offset, positive to the right.
  // REQUIRES: the offset is less than the radius of each arc that turns to its side.
  Path shifted(double lateral_m) const;
  // REQUIRES: 0 <= from_m < to_m <= length_m().
  Path part(double from_m, double to_m) const;

  Directed start() const { return {position_at({0, 0}), heading_rad_at(0)}; }
  Directed end() const { return {position_at({length_m(), 0}), heading_rad_at(length_m())}; }

  double length_m() const { return pieces_.back().from_m + pieces_.back().length_m; }
  // Before the start and after the end the path is extrapolated.
  cv::Vec2d position_at(const RoadPlace& place) const;
  double heading_rad_at(double along_m) const;
  double curvature_per_m_at(double along_m) const;  // positive to the right
  // The nearest point of the path: its arc length, and the position's lateral offset, negative to
  // the left.
  RoadPlace place_of(const cv::Vec2d& position) const;

 private:
  struct Piece {
    double from_m, length_m;
    cv::Vec2d start;
    double heading_rad, curvature_per_m;
  };

  void append(double length_m, double curvature_per_m, const cv::Vec2d& start, double heading_rad);
  void append_arc(const Directed& from, const cv::Vec2d& to);
  const Piece& piece_at(double along_m) const;
  static cv::Vec2d point_of(const Piece& piece, double local_m);
  static double nearest_of(const Piece& piece, const cv::Vec2d& position);

  std::vector<Piece> pieces_;
};

}  // namespace milepost::simulator
