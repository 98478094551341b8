// The landmarks of one stretch, placed on the segments that it passes.
#pragma once

#include <string>
#include <vector>

#include "mapper/fusion/landmark_store.h"
#include "mapper/landmarks/landmark_mapper.h"
#include "mapper/pipeline/build_plan.h"
#include "mapper/pipeline/settings.h"
#include "mapper/pipeline/stretch_plan.h"

namespace milepost {

// A landmark of a pass, in the arc length of the segment's line; nothing if it was not observed
// from the segment.
std::optional<PassLandmark> placed_on(const MappedLandmark& landmark, const RouteLine& driven,
                                      const MappedPass& pass, const RouteLine& segment);

struct WitnessedPlace {
  std::string segment;  // its id; empty: on none
  double along_m = 0;   // of the segment
  ImageWitness witness;
};

// Not safe to use from several threads.
class LandmarkSurvey {
 public:
  // REQUIRES: plan, stretch and store outlive it.
  LandmarkSurvey(const Camera& camera, const StretchPlan& stretch, const BuildPlan& plan,
                 const BuildSettings& settings, LandmarkStore& store)
      : stretch_(stretch),
        plan_(plan),
        tile_length_m_(settings.tile_length_m),
        mapper_(camera, settings.landmarks.landmarks),
        store_(store) {}

  // As LandmarkMapper's.
  void add_frame(const Frame& frame, double along_m) { mapper_.add_frame(frame, along_m); }
  void add_tracks(const std::vector<Track>& tracks) { mapper_.add_tracks(tracks); }
  // Stores what has become final; everything once `finished`. Returns how many landmarks.
  // Errors: those of LandmarkStore.
  Result<std::size_t> store(bool finished);
  // The frames whose poses have become final since the last call.
  std::vector<AdjustedFrame> take_adjusted() { return mapper_.take_adjusted(); }
  // What the images say of such a frame, with the segment that it is on, if any.
  WitnessedPlace place_of(const AdjustedFrame& frame) const;

 private:
  const StretchPlan& stretch_;
  const BuildPlan& plan_;
  double tile_length_m_;
  LandmarkMapper mapper_;
  LandmarkStore& store_;
};

}  // namespace milepost
