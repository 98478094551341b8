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
  std::size_t first = 0, last = 0;  // that are surely on one road
  double surely_m = 0;
};

Alignment part_of(const Alignment& whole, const Together& part) {
  const auto begin = whole.matches.begin();
  return {whole.a,
          whole.b,
          whole.first + part.first,
          {begin + static_cast<std::ptrdiff_t>(part.first),
           begin + static_cast<std::ptrdiff_t>(part.last) + 1}};
}

void add_stretches(const Alignment& alignment, const SameRoadSettings& settings,
                   std::vector<Alignment>& found) {
  const auto reach = static_cast<std::size_t>(settings.smooth_m / 2);
  std::optional<Together> open;
  double gap_m = 0;
  const auto finish = [&] {
    if (open && open->surely_m >= settings.min_length_m) found.push_back(part_of(alignment, *open));
    open.reset();
  };
  for (std::size_t i = 0; i < alignment.matches.size(); ++i) {
    const Match match = smoothed(alignment.matches, i, reach);
    gap_m = is_within(match, settings.may) ? 0 : gap_m + 1;
    if (gap_m > settings.max_gap_m) finish();
    if (!is_within(match, settings.surely)) continue;
    if (!open) open = Together{i, i, 0};
    open->last = i;
    ++open->surely_m;
  }
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
