// A tracklet that is a landmark, too: the default method's map, at half a kilobyte a metre.
//
// A feature of fixed size seen along the optical axis has scale s = f * size / depth. So a place in
// space and a size say all that the regression of the tracklet paper (Eq. 2) says, with -1/s for
// its variable: offset is the along of the place and slope is f * size. What bearings add is the
// position across the road.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "schema/base/range.h"
#include "schema/feature/codebook.h"
#include "schema/geo/geodesy.h"

namespace milepost {

struct Landmark {
  CompactDescriptor descriptor{};  // mean over the observations, of the map's codebook
  EnuPoint position;        // in the tangent frame at the tile's origin; within 327 m, steps of
                            // 1 cm
  float depth_sigma_m = 0;  // of its distance from where it was mapped: (0, 100], steps of 5 %
  float size_m = 0;         // s * depth / f of its feature: (0, 100], steps of 5 %
  float size_sigma = 0;     // of ln(s * depth / f) over the observations: [0, 1]
  AlongRange along;         // capture positions of the first and last observation; steps of 0.1 m
  std::uint8_t observations = 0;  // >= 3; 255 stands for more
};

// The landmarks whose first observation lies in [index, index + 1) * tile length of one segment.
struct LandmarkTile {
  std::string segment;
  std::uint32_t index = 0;
  // Along of the tile's origin: the point of the segment's line there, with the line's altitude,
  // is the origin of the landmarks' tangent frame. No landmark begins before it, nor 6.5 km after.
  double origin_m = 0;
  std::vector<Landmark> landmarks;  // by where they begin

  // The smallest range that holds every landmark's along range. REQUIRES: not empty.
  AlongRange along() const;
};

// The tile as it comes back from its bytes: each value at the nearest step.
LandmarkTile quantized(LandmarkTile tile);

}  // namespace milepost
