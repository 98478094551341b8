#include "mapper/network/u_turns.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace milepost {
namespace {

// Angle between the directions at two states of a way, [0, 180].
double turned_deg(const Way& way, std::size_t from, std::size_t to) {
  const double cosine = way.states[from].forward.dot(way.states[to].forward);
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

}  // namespace

std::vector<AlongRange> u_turns(const Way& way, const UTurnSettings& settings) {
  std::vector<AlongRange> arcs;
  const auto reach = static_cast<std::size_t>(settings.max_length_m);
  for (std::size_t i = 0; i + reach < way.states.size(); ++i) {
    if (turned_deg(way, i, i + reach) < settings.min_turn_deg) continue;
    std::size_t last = i + reach;
    while (last + 1 < way.states.size() &&
           turned_deg(way, i, last + 1) > turned_deg(way, i, last)) {
      ++last;
    }
    std::size_t begin = i;
    while (turned_deg(way, i, begin) < settings.straight_deg) ++begin;
    std::size_t end = last;
    while (turned_deg(way, end, last) < settings.straight_deg) --end;
    arcs.push_back({static_cast<double>(begin), static_cast<double>(end)});
    i = last;
  }
  return arcs;
}

}  // namespace milepost
