#include "schema/tile/tracklet.h"

namespace milepost {

double scale_variable(ScaleModel model, double scale_px) {
  return model == ScaleModel::scale ? scale_px : -1.0 / scale_px;
}

AlongRange TrackletTile::along() const {
  AlongRange range = tracklets.front().along;
  for (const Tracklet& tracklet : tracklets) range = range.joined(tracklet.along);
  return range;
}

}  // namespace milepost
