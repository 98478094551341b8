// Items of a stretch as a segment that is cut from it holds them: in its own arc length.
#pragma once

#include <limits>
#include <optional>

#include "mapper/landmarks/landmark_mapper.h"
#include "schema/base/range.h"
#include "schema/tile/observation.h"

namespace milepost {

// The part of a track that was observed from the segment's begin on, also beyond its end. Nothing
// for a track that begins beyond the end or of which fewer than `min_observations` are left.
std::optional<Track> track_on(const Track& track, const AlongRange& segment,
                              std::size_t min_observations);

// A landmark that was observed from the segment: its range begins in it, and may end beyond it.
// Nothing for one that was not.
std::optional<MappedLandmark> landmark_on(const MappedLandmark& landmark,
                                          const AlongRange& segment);

// The arc length of the segment that is complete once the stretch is up to `along_m`.
inline double complete_on(double along_m, const AlongRange& segment) {
  return along_m >= segment.to_m ? std::numeric_limits<double>::infinity()
                                 : along_m - segment.from_m;
}

}  // namespace milepost
