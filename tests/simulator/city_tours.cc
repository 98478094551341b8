#include "tests/simulator/city_tours.h"

#include <algorithm>
#include <deque>
#include <map>
#include <set>

#include "tests/simulator/city_way.h"

namespace milepost::simulator {
namespace {

constexpr double kMostM = 5000;
constexpr double kJunctionM = 26;  // about the way through a junction

using Turns = std::set<Turn>;

// The edges that can be reached from one, itself included, each with the one before it on the
// shortest way.
std::map<std::size_t, std::size_t> reached_from(const Turns& all, std::size_t from) {
  std::map<std::size_t, std::size_t> before = {{from, from}};
  std::deque<std::size_t> waiting = {from};
  while (!waiting.empty()) {
    const std::size_t at = waiting.front();
    waiting.pop_front();
    for (auto turn = all.lower_bound({at, 0}); turn != all.end() && turn->first == at; ++turn) {
      if (before.emplace(turn->second, at).second) waiting.push_back(turn->second);
    }
  }
  return before;
}

// How many of the open turns can still be taken after an edge, not all of them in one tour.
std::size_t open_after(const Turns& all, const Turns& open, std::size_t edge) {
  const auto reached = reached_from(all, edge);
  return static_cast<std::size_t>(std::count_if(
      open.begin(), open.end(), [&](const Turn& turn) { return reached.contains(turn.first); }));
}

// The edges after `from` up to the end of an open turn: of those after which most turns remain
// open to the tour, the nearest. Empty if there is none.
std::vector<std::size_t> way_to_open(const Turns& all, const Turns& open, std::size_t from) {
  const auto before = reached_from(all, from);
  const auto way_of = [&](std::size_t to) {
    std::vector<std::size_t> way;
    for (std::size_t at = to; at != from; at = before.at(at)) way.push_back(at);
    std::reverse(way.begin(), way.end());
    return way;
  };
  std::vector<std::size_t> best;
  std::size_t most = 0;
  for (const Turn& turn : open) {
    if (!before.contains(turn.first)) continue;
    const std::size_t remaining = open_after(all, open, turn.second);
    std::vector<std::size_t> way = way_of(turn.first);
    way.push_back(turn.second);
    const bool is_better =
        best.empty() || remaining > most || (remaining == most && way.size() < best.size());
    if (!is_better) continue;
    most = remaining;
    best = std::move(way);
  }
  return best;
}

// The begin of the open turn from which most others can be taken.
std::size_t best_start(const Turns& all, const Turns& open) {
  std::size_t best = open.begin()->first;
  std::size_t most = 0;
  for (const Turn& turn : open) {
    const std::size_t remaining = open_after(all, open, turn.first);
    if (remaining <= most) continue;
    most = remaining;
    best = turn.first;
  }
  return best;
}

// Other lanes than the mapping drives': the left one of two, and over to the oncoming one.
std::vector<Pass> in_other_lanes(const City& city, const std::vector<std::size_t>& edges) {
  std::vector<Pass> passes;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge& edge = city.edges[edges[i]];
    Pass pass{edges[i], 1, 0, 0};
    const bool has_room = has_room_for_lane_changes(edge);
    if (edge.lanes_m.size() > 1) {
      const bool leaves = i + 1 < edges.size() && city.edges[edges[i + 1]].road != edge.road;
      pass.lane = leaves ? 1 : 2;
      pass.lane_between = has_room ? 3 - pass.lane : 0;
    } else if (edge.has_oncoming && has_room && i % 2 == 1) {
      pass.lane_between = 2;
    }
    passes.push_back(pass);
  }
  return passes;
}

}  // namespace

std::vector<Turn> turns_of(const CityDrive& drive) {
  std::vector<Turn> turns;
  for (std::size_t i = 0; i + 1 < drive.passes.size(); ++i) {
    turns.emplace_back(drive.passes[i].edge, drive.passes[i + 1].edge);
  }
  return turns;
}

std::vector<CityDrive> tours_over(const City& city) {
  Turns all;
  for (const CityDrive& drive : city.drives) {
    for (const Turn& turn : turns_of(drive)) all.insert(turn);
  }
  const auto length_m = [&](std::size_t edge) {
    return city.edges[edge].middle.length_m() + kJunctionM;
  };
  Turns open = all;
  std::vector<CityDrive> tours;
  while (!open.empty()) {
    const std::size_t start = best_start(all, open);
    std::vector<std::size_t> edges = {start};
    double so_far_m = length_m(start);
    while (true) {
      const std::vector<std::size_t> way = way_to_open(all, open, edges.back());
      if (way.empty()) break;
      double way_m = 0;
      for (const std::size_t edge : way) way_m += length_m(edge);
      if (so_far_m + way_m > kMostM && edges.size() > 1) break;
      so_far_m += way_m;
      for (const std::size_t edge : way) {
        open.erase({edges.back(), edge});
        edges.push_back(edge);
      }
    }
    CityDrive tour;
    tour.is_tour = true;
    tour.says = "turns that the mapping drives took, in other lanes";
    tour.passes = in_other_lanes(city, edges);
    tours.push_back(std::move(tour));
  }
  return tours;
}

}  // namespace milepost::simulator
