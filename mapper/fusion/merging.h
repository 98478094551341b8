// One landmark of what several drives saw of a feature.
#pragma once

#include <deque>
#include <vector>

#include "mapper/fusion/matching.h"
#include "mapper/fusion/pass_landmark.h"

namespace milepost {

struct MergeSettings {
  double cutoff_sigmas = 4;   // between two positions of one landmark, which differ by ...
  double min_sigma_m = 0.05;  // ... this in any case: it is seen from different lanes
  double reach_m = 40;        // between the begins of its ranges
};

// Merges the landmarks of a segment's passes, given by begin. Positions are those after the drives'
// errors were subtracted. Not safe to use from several threads.
class LandmarkMerger {
 public:
  // `local` is a tangent frame near the segment; `passes` the number of its passes.
  LandmarkMerger(const LocalFrame& local, std::size_t passes, const MergeSettings& settings)
      : local_(local), passes_(passes), settings_(settings) {}

  // REQUIRES: does not begin before the one added last.
  void add(const PassLandmark& landmark);
  // The landmarks that begin before `along_m`, by begin; each is returned once. REQUIRES: what is
  // added later begins more than `reach_m` beyond.
  std::vector<MappedLandmark> take_before(double along_m);

  double reach_m() const { return settings_.reach_m; }

 private:
  struct Merged {
    MappedLandmark landmark;
    ComparedLandmark compared;
    std::vector<bool> seen_in;  // for each pass
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
    std::vector<double> descriptor;  // sum over the observations
    double log_sizes = 0;            // the same
  };

  static void absorb(Merged& merged, const PassLandmark& landmark,
                     const ComparedLandmark& compared);
  MappedLandmark finished(Merged merged) const;

  LocalFrame local_;
  std::size_t passes_;
  MergeSettings settings_;
  std::deque<Merged> open_;
};

}  // namespace milepost
