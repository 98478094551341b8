#include "mapper/findings/clock_witness.h"

#include <algorithm>
#include <cmath>

#include "mapper/geodata/between.h"
#include "schema/base/median.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr double kMaxGapS = 1;

// A place between two rows of a series.
struct Between {
  std::size_t before = 0;
  double part = 0;  // of the way to the next
};

// Nothing outside of the series, or in a gap. REQUIRES: times ascend.
template <class Row>
std::optional<Between> between_rows(const std::vector<Row>& rows, double timestamp_s) {
  const auto after = std::ranges::upper_bound(rows, timestamp_s, {}, &Row::timestamp_s);
  if (after == rows.begin() || after == rows.end()) return std::nullopt;
  const auto before = after - 1;
  const double elapsed_s = after->timestamp_s - before->timestamp_s;
  if (elapsed_s > kMaxGapS) return std::nullopt;
  return Between{static_cast<std::size_t>(before - rows.begin()),
                 (timestamp_s - before->timestamp_s) / elapsed_s};
}

// The recorded heading of earlier.
std::optional<double> recorded_deg(const std::vector<WitnessedHeading>& headings,
                                   double timestamp_s) {
  const auto at = between_rows(headings, timestamp_s);
  if (!at) return std::nullopt;
  const double from_deg = headings[at->before].recorded_deg;
  return from_deg + at->part * turn_deg(from_deg, headings[at->before + 1].recorded_deg);
}

// The root mean square of what is left between the turns from frame to frame of the adjusted
// headings and those of the recorded ones of earlier. Turns, for a record that contradicts the
// images bends the adjusted headings slowly. Nothing if fewer than half can be compared.
std::optional<double> left_deg(const std::vector<WitnessedHeading>& headings, double earlier_s) {
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i + 1 < headings.size(); ++i) {
    const WitnessedHeading& from = headings[i];
    const WitnessedHeading& to = headings[i + 1];
    const auto before = recorded_deg(headings, from.timestamp_s - earlier_s);
    const auto after = recorded_deg(headings, to.timestamp_s - earlier_s);
    if (!before || !after || to.timestamp_s - from.timestamp_s > kMaxGapS) continue;
    const double off_deg = turn_deg(from.adjusted_deg, to.adjusted_deg) - turn_deg(*before, *after);
    squares += off_deg * off_deg;
    ++count;
  }
  if (2 * count < headings.size()) return std::nullopt;
  return std::sqrt(squares / static_cast<double>(count));
}

// Whether the recorded headings go with the way between the recorded positions as they are, and not
// with that of so much later.
bool go_with_positions(std::vector<WitnessedHeading> headings, double earlier_s) {
  constexpr double kBetter = 0.8;
  for (std::size_t i = 1; i + 1 < headings.size(); ++i) {
    headings[i].adjusted_deg =
        geodesic_azimuth_deg(headings[i - 1].position, headings[i + 1].position);
  }
  headings.erase(headings.begin());
  headings.pop_back();
  const auto as_they_are = left_deg(headings, 0);
  const auto moved = left_deg(headings, earlier_s);
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
  std::ranges::sort(headings, {}, &WitnessedHeading::timestamp_s);
  std::vector<double> intervals_s;
  double turned_deg = 0;
  for (std::size_t i = 0; i + 1 < headings.size(); ++i) {
    intervals_s.push_back(headings[i + 1].timestamp_s - headings[i].timestamp_s);
    turned_deg += std::abs(turn_deg(headings[i].adjusted_deg, headings[i + 1].adjusted_deg));
  }
  // As they are: the comparison at no offset, of the frames that both have.
  const auto as_recorded = left_deg(headings, 0);
  if (!as_recorded || *as_recorded < kLeastOffDeg || turned_deg < kLeastTurnDeg)
    return std::nullopt;
  const double interval_s = median_of(intervals_s);
  const double step_s = interval_s / 8;
  double best_s = 0;
  double best_deg = *as_recorded;
  const auto steps = static_cast<int>(kMaxOffsetS / step_s);
  for (int i = -steps; i <= steps; ++i) {
    const auto left = left_deg(headings, i * step_s);
    if (!left || *left >= best_deg) continue;
    best_deg = *left;
    best_s = i * step_s;
  }
  // One at the end of what was tried would go on beyond it.
  const bool is_within = std::abs(best_s) <= 0.9 * kMaxOffsetS;
  const bool is_found = is_within && std::abs(best_s) >= interval_s / 2 &&
                        best_deg < kBetter * *as_recorded && go_with_positions(headings, best_s);
  return is_found ? std::optional(best_s) : std::nullopt;
}

Drive with_poses_of(const Drive& drive, double earlier_s) {
  Drive moved = drive;
  moved.frames.clear();
  for (const Frame& frame : drive.frames) {
    const auto at = between_rows(drive.frames, frame.timestamp_s - earlier_s);
    if (!at) continue;
    const Frame& from = drive.frames[at->before];
    const Frame& to = drive.frames[at->before + 1];
    const auto between = [&](double from_deg, double to_deg) {
      return from_deg + at->part * turn_deg(from_deg, to_deg);
    };
    Frame& placed = moved.frames.emplace_back(frame);
    placed.position = position_between(from.position, to.position, at->part);
    placed.heading_deg = wrapped_360(between(from.heading_deg, to.heading_deg));
    placed.pitch_deg = between(from.pitch_deg, to.pitch_deg);
    placed.roll_deg = between(from.roll_deg, to.roll_deg);
    if (from.position_sigma_m) placed.position_sigma_m = from.position_sigma_m;
  }
  return moved;
}

}  // namespace milepost
