#include "schema/tile/landmark.h"

#include "schema/tile/landmark_steps.h"

namespace milepost {

AlongRange LandmarkTile::along() const {
  AlongRange range = landmarks.front().along;
  for (const Landmark& landmark : landmarks) range = range.joined(landmark.along);
  return range;
}

LandmarkTile quantized(LandmarkTile tile) {
  for (Landmark& landmark : tile.landmarks) {
    landmark = landmark_of(steps_of(landmark, tile.origin_m), tile.origin_m);
  }
  return tile;
}

}  // namespace milepost
