// What a report shows of a finder's inside: the walls, and its particles at a few times.
#pragma once

#include <map>
#include <vector>

#include "client/evaluate/find_drive.h"

namespace milepost {

struct FindSnapshot {
  std::size_t frame = 0;
  // Drawn from the belief, so that there are more where more of it lies; in the recorder's frame.
  std::vector<PlanPose> particles;
};

// Looks on while a drive is played. A drive's length and when it is found are not known before, so
// more snapshots are kept than are shown, but never more than a few dozen.
class FindRecorder {
 public:
  // To be called after each frame, in their order.
  void observe(std::size_t frame, FindStatus status, const Finder& finder);

  // What the finder looked in; empty before the first frame.
  const GeoPoint& origin() const { return origin_; }
  const std::vector<PlanWall>& walls() const { return walls_; }

  // At most so many, ascending: at the start, half-way to where the vehicle was found, when it was,
  // when it was lost for the first time, at the end, and at even times for the rest.
  // REQUIRES: most > 4.
  std::vector<FindSnapshot> chosen(std::size_t most) const;

 private:
  void sample(const FindSnapshot& snapshot);

  GeoPoint origin_;
  std::vector<PlanWall> walls_;
  std::map<std::size_t, FindSnapshot> sampled_;  // each stride_ frames
  std::size_t stride_ = 1;
  std::optional<FindSnapshot> found_;
  std::optional<FindSnapshot> lost_;
  FindSnapshot latest_;
};

}  // namespace milepost
