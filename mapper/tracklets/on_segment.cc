#include "mapper/tracklets/on_segment.h"

#include <algorithm>

namespace milepost {

std::optional<Track> track_on(const Track& track, const AlongRange& segment,
                              std::size_t min_observations) {
  const auto first = std::ranges::lower_bound(track, segment.from_m, {}, &Observation::along_m);
  Track part(first, track.end());
  if (part.size() < min_observations || part.front().along_m >= segment.to_m) return std::nullopt;
  for (Observation& observation : part) observation.along_m -= segment.from_m;
  return part;
}

std::optional<MappedLandmark> landmark_on(const MappedLandmark& landmark,
                                          const AlongRange& segment) {
  if (landmark.along.to_m <= segment.from_m || landmark.along.from_m >= segment.to_m)
    return std::nullopt;
  MappedLandmark placed = landmark;
  placed.along = {std::max(landmark.along.from_m, segment.from_m) - segment.from_m,
                  landmark.along.to_m - segment.from_m};
  return placed;
}

}  // namespace milepost
