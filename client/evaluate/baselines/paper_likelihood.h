// The log Bayes factor of frames for the papers' methods. They have no model of "elsewhere": they
// track the best fit, wherever it is. So the first consecutive frames count in favour of a
// hypothesis and later ones hardly: GNSS and the ends of the map decide. Beyond a junction a
// hypothesis may be on a wrong branch: there it is expected to have about as many matches as on the
// road before.
#pragma once

#include <algorithm>

namespace milepost {

class PaperLikelihood {
 public:
  // The log Bayes factor of the next frame; `matches`: its inliers, 0 for methods without any.
  double of_frame(bool measured, int matches) {
    if (frames_of_branch_ > 0 && usual_matches_ > 0) {
      --frames_of_branch_;
      return of_branch(measured ? matches : 0);
    }
    frames_in_turn_ = measured ? std::min(frames_in_turn_ + 1, kFirstFrames + 1) : 0;
    if (!measured) return 0;
    learn(matches);
    return frames_in_turn_ <= kFirstFrames ? kLogBayesFactor : kFollowing;
  }

  // The next frames are of a branch.
  void pass_junction() { frames_of_branch_ = kBranchFrames; }

  static constexpr double kLogBayesFactor = 30;

 private:
  static constexpr int kFirstFrames = 3;
  static constexpr double kFollowing = 1;
  static constexpr int kBranchFrames = 40;    // from a junction on
  static constexpr double kUsualPart = 0.25;  // of the usual matches, that is neutral on a branch
  static constexpr double kPerMatch = 0.2;
  static constexpr double kMaxAgainst = 3;
  static constexpr double kLearned = 0.05;  // of the usual matches, from each frame

  double of_branch(int matches) {
    const double more = matches - kUsualPart * usual_matches_;
    if (more > 0) learn(matches);
    return std::clamp(kPerMatch * more, -kMaxAgainst, kLogBayesFactor);
  }

  void learn(int matches) {
    usual_matches_ += (usual_matches_ > 0 ? kLearned : 1) * (matches - usual_matches_);
  }

  int frames_in_turn_ = 0;
  int frames_of_branch_ = 0;
  double usual_matches_ = 0;  // moving average
};

}  // namespace milepost
