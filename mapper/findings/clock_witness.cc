#include "mapper/findings/clock_witness.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "schema/base/median.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr double kMaxGapS = 1;

Trajectory recorded_in(const std::vector<WitnessedHeading>& headings) {
  std::vector<RecordedPose> poses;
  poses.reserve(headings.size());
  for (const WitnessedHeading& heading : headings) poses.push_back(heading.recorded);
  return {std::move(poses), kMaxGapS};
}

// The root mean square of what is left between the turns from frame to frame of the adjusted
// headings and those of the recorded ones of earlier. Turns, for a record that contradicts the
// images bends the adjusted headings slowly. Nothing if fewer than half can be compared.
std::optional<double> left_deg(const std::vector<WitnessedHeading>& headings,
                               const Trajectory& recorded, double earlier_s) {
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i + 1 < headings.size(); ++i) {
    const WitnessedHeading& from = headings[i];
    const WitnessedHeading& to = headings[i + 1];
    const double from_s = from.recorded.timestamp_s;
    const double to_s = to.recorded.timestamp_s;
    const auto before = recorded.at(from_s - earlier_s);
    const auto after = recorded.at(to_s - earlier_s);
    if (!before || !after || to_s - from_s > kMaxGapS) continue;
    const double off_deg = turn_deg(from.adjusted_deg, to.adjusted_deg) -
                           turn_deg(before->heading_deg, after->heading_deg);
    squares += off_deg * off_deg;
    ++count;
  }
  if (2 * count < headings.size()) return std::nullopt;
  return std::sqrt(squares / static_cast<double>(count));
}

// Whether the recorded headings go with the way between the recorded positions as they are, and not
// with that of so much later.
bool go_with_positions(std::vector<WitnessedHeading> headings, const Trajectory& recorded,
                       double earlier_s) {
  constexpr double kBetter = 0.8;
  for (std::size_t i = 1; i + 1 < headings.size(); ++i) {
    headings[i].adjusted_deg = geodesic_azimuth_deg(headings[i - 1].recorded.attitude.position,
                                                    headings[i + 1].recorded.attitude.position);
  }
  headings.erase(headings.begin());
  headings.pop_back();
  const auto as_they_are = left_deg(headings, recorded, 0);
  const auto moved = left_deg(headings, recorded, earlier_s);
  return as_they_are && moved && *as_they_are < kBetter * *moved;
}

}  // namespace

std::optional<double> clock_offset_s(std::vector<WitnessedHeading> headings) {
  constexpr std::size_t kFewest = 20;
  constexpr double kMaxOffsetS = 1;
  constexpr double kLeastTurnDeg = 5;  // altogether
  constexpr double kLeastOffDeg = 0.15;
  constexpr double kBetter = 0.6;
  if (headings.size() < kFewest) return std::nullopt;
  std::ranges::sort(headings, {},
                    [](const WitnessedHeading& each) { return each.recorded.timestamp_s; });
  const Trajectory recorded = recorded_in(headings);
  std::vector<double> intervals_s;
  double turned_deg = 0;
  for (std::size_t i = 0; i + 1 < headings.size(); ++i) {
    intervals_s.push_back(headings[i + 1].recorded.timestamp_s - headings[i].recorded.timestamp_s);
    turned_deg += std::abs(turn_deg(headings[i].adjusted_deg, headings[i + 1].adjusted_deg));
  }
  // As they are: the comparison at no offset, of the frames that both have.
  const auto as_recorded = left_deg(headings, recorded, 0);
  if (!as_recorded || *as_recorded < kLeastOffDeg || turned_deg < kLeastTurnDeg)
    return std::nullopt;
  const double interval_s = median_of(intervals_s);
  const double step_s = interval_s / 8;
  double best_s = 0;
  double best_deg = *as_recorded;
  const auto steps = static_cast<int>(kMaxOffsetS / step_s);
  for (int i = -steps; i <= steps; ++i) {
    const auto left = left_deg(headings, recorded, i * step_s);
    if (!left || *left >= best_deg) continue;
    best_deg = *left;
    best_s = i * step_s;
  }
  // One at the end of what was tried would go on beyond it.
  const bool is_within = std::abs(best_s) <= 0.9 * kMaxOffsetS;
  const bool is_found = is_within && std::abs(best_s) >= interval_s / 2 &&
                        best_deg < kBetter * *as_recorded &&
                        go_with_positions(headings, recorded, best_s);
  return is_found ? std::optional(best_s) : std::nullopt;
}

Drive with_poses_of(const Drive& drive, double earlier_s) {
  std::vector<RecordedPose> poses;
  poses.reserve(drive.frames.size());
  for (const Frame& frame : drive.frames) {
    poses.push_back(
        {frame.timestamp_s, {frame.position, frame.heading_deg, frame.pitch_deg, frame.roll_deg}});
  }
  const Trajectory trajectory(std::move(poses), kMaxGapS);
  Drive moved = drive;
  moved.frames.clear();
  for (const Frame& frame : drive.frames) {
    const auto at = trajectory.at(frame.timestamp_s - earlier_s);
    if (!at) continue;
    Frame& placed = moved.frames.emplace_back(frame);
    placed.position = at->position;
    placed.heading_deg = at->heading_deg;
    placed.pitch_deg = at->pitch_deg;
    placed.roll_deg = at->roll_deg;
  }
  return moved;
}

}  // namespace milepost
