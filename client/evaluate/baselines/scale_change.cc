#include "client/evaluate/baselines/scale_change.h"

#include <cmath>

namespace milepost {

std::optional<ScaleChange> scale_change(const FeatureSet& query, double scale_ratio,
                                        int image_width_px, const IndexedFrame& map_frame,
                                        const ScaleChangeSettings& settings) {
  const auto neighbours = map_frame.index().nearest(query.descriptors, 2);
  const double ratio_squared = settings.max_distance_ratio * settings.max_distance_ratio;
  const double max_displacement_px = settings.max_displacement * image_width_px;
  ScaleChange change;
  for (std::size_t i = 0; i < query.size(); ++i) {
    if (neighbours[i].size() < 2) continue;
    const Neighbour& nearest = neighbours[i][0];
    if (nearest.distance_squared > ratio_squared * neighbours[i][1].distance_squared) continue;
    const Feature& observed = query.features[i];
    const Feature& stored = map_frame.frame().features.features[nearest.index];
    if (std::hypot(observed.x_px - stored.x_px, observed.y_px - stored.y_px) > max_displacement_px)
      continue;
    change.mean += std::abs(std::log(scale_ratio * observed.scale_px / stored.scale_px));
    ++change.matches;
  }
  if (change.matches < settings.min_matches) return std::nullopt;
  change.mean /= change.matches;
  return change;
}

}  // namespace milepost
