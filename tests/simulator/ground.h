// The ground of a simulated street: asphalt with markings, kerbs and pavements.
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "tests/simulator/centreline.h"

namespace milepost::simulator {

inline constexpr double kRoadHalfWidthM = 3.5;
inline constexpr double kPavementWidthM = 2.5;

// Colours of the plane, by place. Immutable, so safe to share between threads.
class Ground {
 public:
  // The markings' extras (manholes, repairs, a crossing) lie between the two alongs.
  Ground(Centreline line, double from_m, double to_m, std::uint64_t seed);

  // The ground's picture of a square whose north-west corner and side are given, north up.
  cv::Mat paint(const cv::Vec2d& north_west, double side_m, int texels_per_m) const;

 private:
  struct Repair {
    double along_m, lateral_m, length_m, width_m;
    float shade;
  };
  struct Manhole {
    double along_m, lateral_m;
  };

  cv::Vec3f colour_at(const cv::Vec2d& position) const;
  cv::Vec3f road_colour(const StreetPlace& place, float grain) const;
  cv::Vec3f pavement_colour(const StreetPlace& place, float grain) const;
  bool is_marking(const StreetPlace& place) const;

  Centreline line_;
  std::uint64_t seed_;
  double crossing_m_ = 0;  // where the zebra crossing begins
  std::vector<Repair> repairs_;
  std::vector<Manhole> manholes_;
};

}  // namespace milepost::simulator
