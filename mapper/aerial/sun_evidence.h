// Where the sun stood, from the shadows of a picture.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "mapper/aerial/regions.h"

namespace milepost {

// What the blocks of a picture tell of the direction of its shadows: compact regions, most of them
// roofs, are dark beyond the side on which their shadow falls.
class SunEvidence {
 public:
  void add(const RegionMap& map);

  // Where the light comes from, clockwise from north; none if there are no shadows that agree.
  std::optional<double> azimuth_deg() const;

 private:
  Eigen::Vector2d shaded_sides_ = Eigen::Vector2d::Zero();  // east, north: sum of normals
  double shaded_m_ = 0;                                     // length of shaded outline
};

}  // namespace milepost
