// Records the internal state of a global localizer for a report: the walls, and the particles at
// some times.
#pragma once

#include <map>
#include <vector>

#include "client/evaluate/find_drive.h"

namespace milepost {

struct FindSnapshot {
  std::size_t frame = 0;
  // Resampled from the belief, so that their density shows the probability; in the tangent frame at
  // origin().
  std::vector<Pose2> particles;
};

// Observes a replay. The length of the drive and the time of convergence are not known in advance,
// so more snapshots are kept than are shown, but never more than a few dozen.
class FindRecorder {
 public:
  // To be called after each frame, in order.
  void observe(std::size_t frame, GlobalStatus status, const GlobalLocalizer& localizer);

  // The origin of the tangent frame and the walls; empty before the first frame.
  const GeoPoint& origin() const { return origin_; }
  const std::vector<PlanWall>& walls() const { return walls_; }

  // At most `most` snapshots in order of time: at the start, half-way to convergence, at
  // convergence, at the first loss, at the end, and at even intervals for the rest. REQUIRES: most
  // > 4.
  std::vector<FindSnapshot> chosen(std::size_t most) const;

 private:
  void sample(const FindSnapshot& snapshot);

  GeoPoint origin_;
  std::vector<PlanWall> walls_;
  std::map<std::size_t, FindSnapshot> sampled_;  // every stride_ frames
  std::size_t stride_ = 1;
  std::optional<FindSnapshot> found_;
  std::optional<FindSnapshot> lost_;
  FindSnapshot latest_;
};

}  // namespace milepost
