// A tracklet stored as a landmark: the map of the default method, at half a kilobyte per metre.
//
// A feature of fixed size seen along the optical axis has scale s = f * size / depth. So a position
// and a size are equivalent to the regression of the tracklet paper (Eq. 2) with -1/s as variable:
// offset is the position's arc length and slope is f * size. Bearings add the lateral position.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "schema/base/range.h"
#include "schema/feature/pca_projection.h"
#include "schema/geo/geodesy.h"

namespace milepost {

struct Landmark {
  CompactDescriptor descriptor{};  // mean over the observations, of the map's codebook
  EnuPoint position;        // in the tangent frame at the tile's origin; within 327 m, steps of
                            // 1 cm
  float depth_sigma_m = 0;  // of the distance from where it was mapped: (0, 100], steps of 5 %
  float size_m = 0;         // s * depth / f of its feature: (0, 100], steps of 5 %
  float size_sigma = 0;     // of ln(s * depth / f) over the observations: [0, 1]
  AlongRange along;         // capture positions of the first and last observation; steps of 0.1 m
  std::uint8_t observations = 0;  // >= 3; saturates at 255
  std::uint8_t passes = 1;        // drives that saw it, >= 1; saturates at 255
  // Where it was mapped, in the middle of its range: to the right of the segment's line, within
  // 12.7 m, steps of 0.1 m. Not 0 where the line is another drive's.
  float right_m = 0;
};

// The landmarks whose first observation lies in [index, index + 1) * tile length of one segment.
struct LandmarkTile {
  std::string segment;
  std::uint32_t index = 0;
  // Arc length of the tile's origin: the point of the segment's line there, with the line's
  // altitude, is the origin of the landmarks' tangent frame. No landmark begins before it, nor
  // 6.5 km after.
  double origin_m = 0;
  std::vector<Landmark> landmarks;  // by begin of their range

  // The smallest range that contains every landmark's range. REQUIRES: not empty.
  AlongRange along() const;
};

// The tile after encoding and decoding: each value rounded to the nearest step.
LandmarkTile quantized(LandmarkTile tile);

}  // namespace milepost
