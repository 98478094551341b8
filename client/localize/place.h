// The places where the camera may be, weighed against each other and elsewhere: another place of
// the map, or none of it.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "client/fetch/segment_layer.h"
#include "client/localize/coarse_position.h"
#include "client/localize/follower.h"
#include "client/localize/place_odds.h"
#include "client/localize/receiver_evidence.h"

namespace milepost {

inline constexpr double kEndMarginM = 5;  // the vehicle may be so far beyond a segment's ends

inline constexpr double kSamePlaceM = 4;  // two beliefs so near to each other are one
inline constexpr double kAgreedM = 0.5;   // ... and independent poses agree

// A segment that is looked at.
struct OpenSegment {
  std::shared_ptr<const SegmentLayer> layer;
  std::unique_ptr<Scout> scout;
};

// One place where the camera may be, with the odds that it is, against elsewhere.
struct Place {
  std::shared_ptr<OpenSegment> segment;
  std::unique_ptr<Follower> follower;
  PlaceOdds odds;
  ReceiverEvidence receiver;
  double timestamp_s = 0;       // of the last frame
  bool measured = false;        // ... was it
  double log_bayes_factor = 0;  // ... what did it say
  int matches = 0;
  bool weighed = false;  // ... is that part of the odds
  // ... and how far off another pose is that as much of it agrees with, found independently.
  double apart_m = 0;

  const SegmentLayer& layer() const { return *segment->layer; }
  GeoPoint position() const;
  bool is_on_segment(double along_m) const;
  // Whether its segment ends within so much ahead.
  bool is_near_end(double ahead_m) const;

  // One frame further.
  Followed advance(SeenFrame& frame);
  // Adds to the odds what the last frame says, and the receiver, if it tells. `best` is what the
  // frame says for the place it speaks for most.
  void weigh(double best, const std::optional<CoarsePosition>& reading);
};

// Weighs all places by the last frame and the receiver. Those that are one become one; those that
// are unlikely, and more than `most`, are dropped; the likeliest comes first.
void weigh(std::vector<Place>& places, const std::optional<CoarsePosition>& reading,
           std::size_t most);

// The logarithm of the odds of the first place against all others and elsewhere.
// REQUIRES: there is one.
double log_odds_of_first(const std::vector<Place>& places);

// What the motion since a place was left over the end of its segment says for another place on it:
// the map may look there as beyond its end. A logarithm; 0 where nothing speaks against it.
double log_density_after(const Place& left, const Place& place);

}  // namespace milepost
