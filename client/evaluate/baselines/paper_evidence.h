// What the papers' methods say for a place. They know no elsewhere: they follow what fits best,
// wherever it is. So the first frames in turn speak for the place, and those that follow hardly:
// the receiver and the ends of the map decide.
#pragma once

#include <algorithm>

namespace milepost {

class PaperEvidence {
 public:
  // Logarithm of the Bayes factor of the next frame.
  double of_frame(bool measured) {
    frames_in_turn_ = measured ? std::min(frames_in_turn_ + 1, kFirstFrames + 1) : 0;
    if (!measured) return 0;
    return frames_in_turn_ <= kFirstFrames ? kLogBayesFactor : kFollowing;
  }

  static constexpr double kLogBayesFactor = 30;

 private:
  static constexpr int kFirstFrames = 3;
  static constexpr double kFollowing = 1;

  int frames_in_turn_ = 0;
};

}  // namespace milepost
