// A trajectory at its own rate: poses at the images' times, and headings told by the motion.
#pragma once

#include <optional>
#include <vector>

#include "schema/geo/mounting.h"

namespace milepost {

// Of the vehicle's reference point, or of the camera, as the layout records it.
struct RecordedPose {
  double timestamp_s = 0;
  GeoAttitude attitude;
};

// A time without poses.
struct TrajectoryGap {
  double from_s = 0;
  double to_s = 0;
};

class Trajectory {
 public:
  // Sorts the poses; of several at one time the first is kept. REQUIRES: there are two times.
  Trajectory(std::vector<RecordedPose> poses, double max_gap_s);

  double begin_s() const { return poses_.front().timestamp_s; }
  double end_s() const { return poses_.back().timestamp_s; }
  const std::vector<TrajectoryGap>& gaps() const { return gaps_; }
  const std::vector<RecordedPose>& poses() const { return poses_; }

  // Between two poses: the position on the line through them, the angles the short way round.
  // Nothing before the first, after the last by more than times are rounded, or in a gap.
  std::optional<GeoAttitude> at(double timestamp_s) const;

  // Gives each pose the direction of the way from some metres behind it to some ahead; a standing
  // vehicle keeps its heading.
  void set_headings_by_motion();

 private:
  std::vector<RecordedPose> poses_;
  double max_gap_s_;
  std::vector<TrajectoryGap> gaps_;
};

}  // namespace milepost
