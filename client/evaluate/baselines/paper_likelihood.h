// The log Bayes factor of frames for the papers' methods. They have no model of "elsewhere": they
// track the best fit, wherever it is. So the first consecutive frames count in favour of a
// hypothesis and later ones hardly: GNSS and the ends of the map decide.
#pragma once

#include <algorithm>

namespace milepost {

class PaperLikelihood {
 public:
  // The log Bayes factor of the next frame.
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
