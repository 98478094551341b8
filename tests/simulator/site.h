// The ground of a town: free space for objects.
#pragma once

#include <optional>
#include <vector>

#include "tests/simulator/building.h"
#include "tests/simulator/network.h"
#include "tests/simulator/scene.h"

namespace milepost::simulator {

// A position beside a road: on the ground, with the road's direction and the side that faces it.
struct Standing {
  Point foot;
  cv::Vec2d forward;  // unit vector along the road
  cv::Vec2d to_road;  // unit vector across, towards the road
};

// Refers to a network and its buildings, which must outlive it.
class Site {
 public:
  Site(const Network& network, const std::vector<Building>& buildings)
      : network_(network), buildings_(buildings) {}

  const Network& network() const { return network_; }

  Point on_ground(const cv::Vec2d& position) const;
  // Whether there is a house within a margin of the position.
  bool is_built_on(const cv::Vec2d& position, double margin_m) const;
  // `off_m` beyond the edge of a carriageway, to the right (+1) or left (-1); nothing if another
  // road or a house is there.
  std::optional<Standing> beside(const Road& road, double along_m, int side, double off_m) const;
  // Whether another road crosses or opens within some metres of a point in the middle of a road.
  bool is_near_junction(const Road& road, double along_m) const;

 private:
  const Network& network_;
  const std::vector<Building>& buildings_;
};

}  // namespace milepost::simulator
