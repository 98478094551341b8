#include "mapper/network/same_road.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace milepost {
namespace {

// The match at `i` with the means over all that were found within `reach` of it.
Match smoothed(const std::vector<Match>& matches, std::size_t i, std::size_t reach) {
  Match mean = matches[i];
  if (std::isinf(mean.apart_m)) return mean;
  mean.apart_m = mean.turn_deg = mean.climb_m = 0;
  double count = 0;
  reach = std::min({reach, i, matches.size() - 1 - i});
  for (std::size_t k = i - reach; k <= i + reach; ++k) {
    if (std::isinf(matches[k].apart_m)) continue;
    mean.apart_m += matches[k].apart_m;
    mean.turn_deg += matches[k].turn_deg;
    mean.climb_m += matches[k].climb_m;
    ++count;
  }
  mean.apart_m /= count;
  mean.turn_deg /= count;
  mean.climb_m /= count;
  return mean;
}

bool is_within(const Match& match, const RoadLimits& limits) {
  return match.apart_m <= limits.apart_m && match.turn_deg <= limits.turn_deg &&
         match.climb_m <= limits.climb_m;
}

// A stretch of an alignment, by indices of its matches.
struct Together {
  std::size_t first = 0, last = 0;
  double surely_m = 0;

  double length_m() const { return static_cast<double>(last - first + 1); }
};

Alignment part_of(const Alignment& whole, const Together& part) {
  const auto begin = whole.matches.begin();
  return {whole.a,
          whole.b,
          whole.first + part.first,
          {begin + static_cast<std::ptrdiff_t>(part.first),
           begin + static_cast<std::ptrdiff_t>(part.last) + 1}};
}

// Where the ways may be together up to an end of the alignment, one of them ends there: they do not
// part, so the stretch holds up to it.
void add_stretches(const Alignment& alignment, const SameRoadSettings& settings,
                   std::vector<Alignment>& found) {
  const auto reach = static_cast<std::size_t>(settings.smooth_m / 2);
  std::optional<Together> open;
  std::size_t may_since = 0;  // all from here to the current match may be together
  double gap_m = 0;
  const auto finish = [&] {
    const bool is_road = open && open->surely_m >= settings.min_surely_m &&
                         open->surely_m >= settings.min_surely_part * open->length_m();
    if (is_road) found.push_back(part_of(alignment, *open));
    open.reset();
  };
  for (std::size_t i = 0; i < alignment.matches.size(); ++i) {
    const Match match = smoothed(alignment.matches, i, reach);
    if (is_within(match, settings.may)) {
      gap_m = 0;
    } else {
      ++gap_m;
      may_since = i + 1;
    }
    if (gap_m > settings.max_gap_m) finish();
    if (!is_within(match, settings.surely)) continue;
    if (!open) open = Together{may_since == 0 ? 0 : i, i, 0};
    open->last = i;
    ++open->surely_m;
  }
  if (open && may_since <= open->last) open->last = alignment.matches.size() - 1;
  finish();
}

}  // namespace

std::vector<Alignment> same_road(const std::vector<Alignment>& alignments,
                                 const SameRoadSettings& settings) {
  std::vector<Alignment> found;
  for (const Alignment& alignment : alignments) add_stretches(alignment, settings, found);
  return found;
}

}  // namespace milepost
