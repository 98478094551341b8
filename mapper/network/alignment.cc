#include "mapper/network/alignment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mapper/network/state_grid.h"

namespace milepost {
namespace {

struct Candidate {
  std::size_t b = 0;
  Match match;
};

double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * 180 / std::numbers::pi;
}

// How far `to` lies ahead of the cross-section through `from`; its sign changes on exchange.
double ahead_of_section_m(const RoadState& from, const RoadState& to) {
  return (to.position_m - from.position_m).dot((from.forward + to.forward).normalized());
}

// Walks along one way and carries the alignments with all later ones.
class Aligner {
 public:
  Aligner(const std::vector<Way>& ways, const StateGrid& grid, const AlignmentSettings& settings)
      : ways_(ways), grid_(grid), settings_(settings) {}

  void align(std::size_t a, std::vector<Alignment>& found) {
    for (std::size_t i = 0; i < ways_[a].states.size(); ++i) {
      close_those_before(i, found);
      for (const Candidate& candidate : candidates(a, i)) extend(a, i, candidate);
    }
    std::ranges::move(open_, std::back_inserter(found));
    open_.clear();
  }

 private:
  bool is_comparable(std::size_t a, std::size_t i, const StateIndex& other) const {
    if (other.way < a) return false;
    if (other.way == a && other.state < static_cast<double>(i) + settings_.min_lap_m) return false;
    return angle_deg(ways_[a].states[i].forward, ways_[other.way].states[other.state].forward) <=
           settings_.max_turn_deg;
  }

  // Where other ways pass the cross-section of a's i-th state: between a state behind it and the
  // next, which is not.
  std::vector<Candidate> candidates(std::size_t a, std::size_t i) const {
    const RoadState& state = ways_[a].states[i];
    std::vector<StateIndex> beside = grid_.near(state.position_m);
    std::erase_if(beside, [&](const StateIndex& other) { return !is_comparable(a, i, other); });
    std::vector<Candidate> found;
    for (std::size_t k = 0; k + 1 < beside.size(); ++k) {
      if (beside[k].way != beside[k + 1].way || beside[k].state + 1 != beside[k + 1].state)
        continue;
      const Way& b = ways_[beside[k].way];
      const double behind_m = -ahead_of_section_m(state, b.states[beside[k].state]);
      const double ahead_m = ahead_of_section_m(state, b.states[beside[k + 1].state]);
      if (behind_m < 0 || ahead_m <= 0) continue;
      const double part = behind_m / (behind_m + ahead_m);
      found.push_back({beside[k].way, match(ways_[a], i, b, beside[k].state, part)});
    }
    return found;
  }

  static Match match(const Way& way_a, std::size_t i, const Way& way_b, std::size_t j,
                     double part) {
    const RoadState& a = way_a.states[i];
    const RoadState& before = way_b.states[j];
    const RoadState& after = way_b.states[j + 1];
    const auto between = [part](const auto& x, const auto& y) { return x + part * (y - x); };
    Match found;
    found.along_b_m = static_cast<double>(j) + part;
    const Eigen::Vector3d position_m =
        before.position_m + part * (after.position_m - before.position_m);
    const Eigen::Vector3d forward = before.forward + part * (after.forward - before.forward);
    found.apart_m = (position_m - a.position_m).norm();
    found.turn_deg = angle_deg(a.forward, forward.normalized());
    if (way_a.has_altitudes && way_b.has_altitudes) {
      found.climb_m = std::abs(between(before.altitude_m, after.altitude_m) - a.altitude_m);
    }
    return found;
  }

  static std::size_t next_state(const Alignment& alignment) {
    return alignment.first + alignment.matches.size();
  }

  // By how much a candidate misses the place where an alignment would be at a's i-th state.
  double slip_m(const Alignment& alignment, std::size_t i, const Candidate& candidate) const {
    if (alignment.b != candidate.b || next_state(alignment) > i) {
      return std::numeric_limits<double>::infinity();
    }
    const auto advanced = static_cast<double>(i + 1 - next_state(alignment));
    return std::abs(candidate.match.along_b_m - alignment.matches.back().along_b_m - advanced);
  }

  void extend(std::size_t a, std::size_t i, const Candidate& candidate) {
    const auto nearest = std::ranges::min_element(
        open_, {}, [&](const Alignment& open) { return slip_m(open, i, candidate); });
    if (nearest == open_.end() || slip_m(*nearest, i, candidate) > settings_.max_slip_m) {
      open_.push_back({a, candidate.b, i, {candidate.match}});
      return;
    }
    append(*nearest, i, candidate.match);
  }

  // States without a match in between are told apart by an infinite distance.
  static void append(Alignment& alignment, std::size_t i, Match match) {
    const Match last = alignment.matches.back();
    match.along_b_m = std::max(match.along_b_m, last.along_b_m);
    const std::size_t begin = next_state(alignment);
    const double step_m = (match.along_b_m - last.along_b_m) / static_cast<double>(i + 1 - begin);
    for (std::size_t missing = begin; missing < i; ++missing) {
      Match filled;
      filled.along_b_m = last.along_b_m + step_m * static_cast<double>(missing + 1 - begin);
      filled.apart_m = std::numeric_limits<double>::infinity();
      alignment.matches.push_back(filled);
    }
    alignment.matches.push_back(match);
  }

  void close_those_before(std::size_t i, std::vector<Alignment>& found) {
    const auto is_open = [&](const Alignment& alignment) {
      return static_cast<double>(next_state(alignment)) + settings_.max_missing_m >=
             static_cast<double>(i);
    };
    const auto closed = std::stable_partition(open_.begin(), open_.end(), is_open);
    std::move(closed, open_.end(), std::back_inserter(found));
    open_.erase(closed, open_.end());
  }

  const std::vector<Way>& ways_;
  const StateGrid& grid_;
  const AlignmentSettings& settings_;
  std::vector<Alignment> open_;
};

}  // namespace

std::vector<Alignment> alignments(const std::vector<Way>& ways, const AlignmentSettings& settings) {
  const StateGrid grid(ways, settings.reach_m);
  Aligner aligner(ways, grid, settings);
  std::vector<Alignment> found;
  for (std::size_t a = 0; a < ways.size(); ++a) aligner.align(a, found);
  return found;
}

}  // namespace milepost
