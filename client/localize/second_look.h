// The pose of a place that is followed, found anew now and then without the belief.
#pragma once

#include <vector>

#include "client/localize/place.h"

namespace milepost {

// A belief that slipped into a pose that only a part of the frame agrees with stays there, for it
// searches landmarks where it expects them, and the far ones agree with many poses.
class SecondLook {
 public:
  // Often at first and while the pose is uncertain, then each few metres.
  bool is_due(double along_m) const;
  // The camera to look by: as it was given at first and while the pose is uncertain, for then what
  // the belief learned of it may be as wrong as its pose; later as it is known by now.
  std::optional<LearnedCamera> camera(const Place& place) const;
  // What was seen at the place without its belief. Where about as much of the frame agrees with
  // another pose, the place is that uncertain (`apart_m`) for some looks; where more does, twice in
  // turn, the belief begins again from there.
  void compare(Place& place, std::vector<Sighting> sightings);

 private:
  int looks_ = 0;
  double looked_from_m_ = 0;
  int against_ = 0;     // so many looks in turn
  double apart_m_ = 0;  // of the latest rival ...
  int calm_ = 0;        // ... and so many looks since
};

}  // namespace milepost
