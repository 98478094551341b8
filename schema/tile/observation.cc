#include "schema/tile/observation.h"

#include <algorithm>

namespace milepost {
namespace {

Descriptor mean_descriptor(const Track& track) {  // Eq. 15
  Descriptor mean{};
  for (std::size_t k = 0; k < mean.size(); ++k) {
    std::size_t sum = 0;
    for (const Observation& observation : track) sum += observation.descriptor[k];
    mean[k] = static_cast<std::uint8_t>((sum + track.size() / 2) / track.size());
  }
  return mean;
}

}  // namespace

void set_from_track(const Track& track, Tracklet& tracklet) {
  const Feature& first = track.front().feature;
  tracklet.descriptor = mean_descriptor(track);
  tracklet.observations =
      static_cast<std::uint16_t>(std::min(track.size(), std::size_t{UINT16_MAX}));
  tracklet.along = {track.front().along_m, track.back().along_m};
  tracklet.scale_min_px = tracklet.scale_max_px = first.scale_px;
  tracklet.pixels = {first.x_px, first.x_px, first.y_px, first.y_px};
  for (const Observation& observation : track) {
    const Feature& feature = observation.feature;
    tracklet.scale_min_px = std::min(tracklet.scale_min_px, feature.scale_px);
    tracklet.scale_max_px = std::max(tracklet.scale_max_px, feature.scale_px);
    tracklet.pixels.x_min_px = std::min(tracklet.pixels.x_min_px, feature.x_px);
    tracklet.pixels.x_max_px = std::max(tracklet.pixels.x_max_px, feature.x_px);
    tracklet.pixels.y_min_px = std::min(tracklet.pixels.y_min_px, feature.y_px);
    tracklet.pixels.y_max_px = std::max(tracklet.pixels.y_max_px, feature.y_px);
  }
}

}  // namespace milepost
