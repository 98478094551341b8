// The texture of a town's ground: roads with markings, kerbs, pavements, yards, grass.
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "tests/simulator/network.h"

namespace milepost::simulator {

// Colours of the ground by position. Immutable, so safe to share between threads.
class Ground {
 public:
  Ground(const Network& network, std::uint64_t seed);

  // The picture of a square whose north-west corner and side are given, north up. Where a bridge
  // is over the square's middle it is without the bridge's road.
  cv::Mat paint(const cv::Vec2d& north_west, double side_m, int texels_per_m) const;
  // The same of a bridge's deck: without the road below it.
  cv::Mat paint_deck(const Bridge& bridge, const cv::Vec2d& north_west, double side_m,
                     int texels_per_m) const;

 private:
  struct Repair {
    RoadPlace place;
    double length_m, width_m;
    float shade;
  };
  // The markings of one road.
  struct Fittings {
    std::vector<Repair> repairs;
    std::vector<RoadPlace> manholes;
    std::vector<double> crossings;   // begins of zebra crossings
    std::vector<RoadPlace> arrows;   // their tails; the lateral offset determines the lane
    std::vector<double> stop_lines;  // signed by the side of the road: + right, - left
    std::vector<double> stop_alongs;
  };
  // A road near a position, relative to the position.
  struct Near {
    std::size_t road;
    RoadPlace place;
    double beyond_edge_m;  // negative on the carriageway
  };

  // The roads near a square.
  std::vector<std::size_t> roads_near(const cv::Vec2d& middle, double side_m) const;
  cv::Mat paint(const cv::Vec2d& north_west, double side_m, int texels_per_m,
                const std::vector<std::size_t>& roads) const;
  cv::Vec3f colour_at(const cv::Vec2d& position, const std::vector<std::size_t>& roads) const;
  // `others_m` and `beyond_m`: to the edges of the other roads, and of all with rounded corners.
  cv::Vec3f road_colour(const Near& near, double others_m, double beyond_m,
                        const cv::Vec2d& position, float grain) const;
  cv::Vec3f pavement_colour(const Near& near, double beyond_m, float grain) const;
  cv::Vec3f yard_colour(const cv::Vec2d& position, Frontage frontage, double beyond_m,
                        float grain) const;
  bool is_marking(const Near& near, double others_m) const;

  const Network network_;
  std::uint64_t seed_;
  std::vector<Fittings> fittings_;
};

}  // namespace milepost::simulator
