#include "mapper/network/cross_sections.h"

#include <algorithm>
#include <cmath>

namespace milepost {
namespace {

constexpr double kSamePassM = 10;  // places of one way within this are one pass

bool holds(const std::vector<Place>& places, const Place& place) {
  return std::ranges::any_of(places, [&](const Place& other) {
    return other.way == place.way && std::abs(other.along_m - place.along_m) < kSamePassM;
  });
}

}  // namespace

CrossSections::CrossSections(const std::vector<Way>& ways, const std::vector<Alignment>& same)
    : ways_(ways) {
  partners_.reserve(ways.size());
  for (const Way& way : ways) partners_.emplace_back(way.states.size());
  for (const Alignment& alignment : same) add(alignment);
}

void CrossSections::add(const Alignment& same) {
  const std::vector<Match>& matches = same.matches;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    partners_[same.a][same.first + i].push_back({same.b, matches[i].along_b_m});
  }
  std::size_t i = 0;  // b's state lies between the matches i and i + 1
  const auto first_state = static_cast<std::size_t>(std::ceil(matches.front().along_b_m));
  const auto last_state = static_cast<std::size_t>(matches.back().along_b_m);
  for (std::size_t state = first_state; state <= last_state; ++state) {
    const auto b_m = static_cast<double>(state);
    while (i + 2 < matches.size() && matches[i + 1].along_b_m < b_m) ++i;
    const double edge_m = matches[i + 1].along_b_m - matches[i].along_b_m;
    const double part = edge_m > 0 ? (b_m - matches[i].along_b_m) / edge_m : 0;
    const double along_a_m = static_cast<double>(same.first + i) + std::clamp(part, 0.0, 1.0);
    partners_[same.b][state].push_back({same.a, along_a_m});
  }
}

const std::vector<Place>& CrossSections::partners(const Place& place) const {
  return partners_[place.way][nearest_state(ways_[place.way], place.along_m)];
}

std::vector<Place> CrossSections::places(const Place& place) const {
  std::vector<Place> found = {place};
  for (std::size_t next = 0; next < found.size(); ++next) {
    const Place from = found[next];
    const double off_state_m =
        from.along_m - static_cast<double>(nearest_state(ways_[from.way], from.along_m));
    for (const Place& partner : partners(from)) {
      const double along_m = partner.along_m + off_state_m;
      const Place beside{partner.way, std::clamp(along_m, 0.0, ways_[partner.way].length_m)};
      if (!holds(found, beside)) found.push_back(beside);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace milepost
