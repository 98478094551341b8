// The middle line of a simulated street: an arc of constant, gentle curvature.
#pragma once

#include <opencv2/core.hpp>

namespace milepost::simulator {

struct StreetPlace {
  double along_m = 0;
  double lateral_m = 0;  // positive to the right of the direction of driving
};

class Centreline {
 public:
  // Starts at the origin of the local frame. `curvature_per_m` is one over the radius, positive
  // for a right turn; 0 is straight.
  Centreline(double heading_deg, double curvature_per_m);

  double heading_deg_at(double along_m) const;            // clockwise from north, not wrapped
  cv::Vec2d position_at(const StreetPlace& place) const;  // metres east and north
  StreetPlace place_of(const cv::Vec2d& position) const;  // the nearest, within half a turn

 private:
  double heading_deg_;
  double curvature_per_m_;
  cv::Vec2d start_forward_;
  cv::Vec2d start_right_;
};

}  // namespace milepost::simulator
