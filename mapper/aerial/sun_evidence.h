// Where the sun stood, from the shadows of a picture.
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "mapper/aerial/regions.h"

namespace milepost {

// What the blocks of a picture tell of the direction of its shadows. Compact regions, most of them
// roofs, are dark beyond the sides on which their shadows fall: that tells the direction roughly,
// for a side is in shade whatever the angle. From a roof's outermost corners the borders of its
// shadow run just as the light does: that tells it well.
class SunEvidence {
 public:
  void add(const RegionMap& map);

  // Where the light comes from, clockwise from north; none if there are no shadows that agree.
  std::optional<double> azimuth_deg() const;

 private:
  static constexpr int kDirections = 180;

  std::optional<double> rough_azimuth_deg() const;
  // Around a direction of the light: how well borders of shadows run along it.
  double border_at(int direction) const;

  Eigen::Vector2d shaded_sides_ = Eigen::Vector2d::Zero();  // east, north: sum of normals
  double shaded_m_ = 0;                                     // length of shaded outline
  std::array<double, kDirections> borders_{};               // by azimuth, two degrees apart
};

}  // namespace milepost
