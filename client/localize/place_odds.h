// The sequential test of one place against elsewhere: another place of the map, or none of it.
#pragma once

namespace milepost {

struct PlaceOddsSettings {
  // All in natural logarithms of odds.
  double first = -3;         // of a place before anything spoke for it
  double max_for = 6;        // of one frame ...
  double max_against = 4.6;  // ... and against: what is seen may be hidden by a truck
  double claim = 6;          // from which a place is claimed ...
  double hold = 4.5;         // ... down to which a measurement of it counts ...
  double doubt = 2;          // ... what they are at most after a frame that speaks against it ...
  double give_up = 0;        // ... and below which it is no longer the place
  // Frames see the same landmarks again: what speaks for a place counts as far as the vehicle has
  // driven on to others since, whole after so many metres. What speaks against it counts whole.
  double novel_m = 5;
  // Within so many metres the vehicle may leave the map, or the belief slip. Bounds the odds.
  double lapse = 0.004;
};

class PlaceOdds {
 public:
  explicit PlaceOdds(const PlaceOddsSettings& settings)
      : settings_(settings), log_(settings.first) {}

  // So far on.
  void move(double by_m);
  // What the frame says, seen from along_m; `best` is what it says for the place it speaks for
  // most.
  void add_frame(double log_bayes_factor, double best, double along_m);
  // What another witness says.
  void add(double log_bayes_factor) { log_ += log_bayes_factor; }

  double log() const { return log_; }

 private:
  PlaceOddsSettings settings_;
  double log_;
  bool seen_ = false;
  double seen_from_m_ = 0;  // where a frame last spoke for it
};

}  // namespace milepost
