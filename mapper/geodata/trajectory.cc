#include "mapper/geodata/trajectory.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mapper/geodata/between.h"

namespace milepost {

Trajectory::Trajectory(std::vector<RecordedPose> poses, double max_gap_s)
    : poses_(std::move(poses)), max_gap_s_(max_gap_s) {
  std::ranges::stable_sort(poses_, {}, &RecordedPose::timestamp_s);
  const auto is_repeated = [](const RecordedPose& a, const RecordedPose& b) {
    return a.timestamp_s == b.timestamp_s;
  };
  poses_.erase(std::unique(poses_.begin(), poses_.end(), is_repeated), poses_.end());
  for (std::size_t i = 1; i < poses_.size(); ++i) {
    const double from_s = poses_[i - 1].timestamp_s;
    const double to_s = poses_[i].timestamp_s;
    if (to_s - from_s > max_gap_s_) gaps_.push_back({from_s, to_s});
  }
}

std::optional<GeoAttitude> Trajectory::at(double timestamp_s) const {
  const auto after = std::ranges::lower_bound(poses_, timestamp_s, {}, &RecordedPose::timestamp_s);
  constexpr double kRoundingS = 0.001;
  const auto is_at = [&](const RecordedPose& pose) {
    return std::abs(pose.timestamp_s - timestamp_s) <= kRoundingS;
  };
  if (after == poses_.end())
    return is_at(poses_.back()) ? std::optional(poses_.back().attitude) : std::nullopt;
  if (after->timestamp_s == timestamp_s) return after->attitude;
  if (after == poses_.begin())
    return is_at(poses_.front()) ? std::optional(poses_.front().attitude) : std::nullopt;
  const RecordedPose& from = *(after - 1);
  const RecordedPose& to = *after;
  const double elapsed_s = to.timestamp_s - from.timestamp_s;
  if (elapsed_s > max_gap_s_) return std::nullopt;
  const double part = (timestamp_s - from.timestamp_s) / elapsed_s;
  const auto between = [&](double from_deg, double to_deg) {
    return from_deg + part * turn_deg(from_deg, to_deg);
  };
  const GeoAttitude& a = from.attitude;
  const GeoAttitude& b = to.attitude;
  return GeoAttitude{position_between(a.position, b.position, part),
                     wrapped_360(between(a.heading_deg, b.heading_deg)),
                     between(a.pitch_deg, b.pitch_deg), between(a.roll_deg, b.roll_deg)};
}

void Trajectory::set_headings_by_motion() {
  constexpr double kReachM = 1.5;
  const auto apart_m = [&](std::size_t a, std::size_t b) {
    return geodesic_distance_m(poses_[a].attitude.position, poses_[b].attitude.position);
  };
  std::optional<double> latest_deg;
  std::size_t behind = 0;
  std::size_t ahead = 0;
  std::size_t unknown = 0;  // at the beginning
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    while (behind + 1 < i && apart_m(behind + 1, i) >= kReachM) ++behind;
    ahead = std::max(ahead, i);
    while (ahead + 1 < poses_.size() && apart_m(i, ahead) < kReachM) ++ahead;
    if (apart_m(behind, ahead) >= kReachM) {
      latest_deg = wrapped_360(
          geodesic_azimuth_deg(poses_[behind].attitude.position, poses_[ahead].attitude.position));
    }
    if (latest_deg) {
      poses_[i].attitude.heading_deg = *latest_deg;
    } else {
      ++unknown;
    }
  }
  for (std::size_t i = 0; i < unknown && unknown < poses_.size(); ++i)
    poses_[i].attitude.heading_deg = poses_[unknown].attitude.heading_deg;
}

}  // namespace milepost
