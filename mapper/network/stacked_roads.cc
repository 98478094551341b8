#include "mapper/network/stacked_roads.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace milepost {
namespace {

// The group before or behind a piece, by index.
using Neighbour = std::optional<std::size_t>;

struct Neighbours {
  std::map<Place, std::size_t> by_begin, by_end;

  explicit Neighbours(const std::vector<PieceGroup>& groups) : by_begin(groups_by_begin(groups)) {
    for (std::size_t group = 0; group < groups.size(); ++group) {
      for (const Piece& piece : groups[group]) by_end[piece.end()] = group;
    }
  }
  Neighbour before(const Piece& piece) const { return find(by_end, piece.begin()); }
  Neighbour behind(const Piece& piece) const { return find(by_begin, piece.end()); }

 private:
  static Neighbour find(const std::map<Place, std::size_t>& groups, const Place& place) {
    const auto found = groups.find(place);
    return found == groups.end() ? Neighbour() : Neighbour(found->second);
  }
};

bool is_straight_at(const Way& way, double along_m, const StackedSettings& settings) {
  const RoadState& from = way.states[nearest_state(way, along_m - settings.look_m)];
  const RoadState& to = way.states[nearest_state(way, along_m + settings.look_m)];
  return from.forward.dot(to.forward) >=
         std::cos(settings.max_straight_deg * std::numbers::pi / 180);
}

// Whether it may be that a piece passes above or below others unnoticed.
bool may_be_stacked(const Piece& piece, const Way& way, const Neighbours& neighbours,
                    const StackedSettings& settings) {
  return neighbours.before(piece) && neighbours.behind(piece) &&
         is_straight_at(way, piece.from_m, settings) && is_straight_at(way, piece.to_m, settings);
}

// Splits a group into the pieces that share roads before or behind with the first one, directly or
// through others, and the rest.
StackedPieces parted(const PieceGroup& group, const Neighbours& neighbours) {
  StackedPieces result;
  result.lower = {group.front()};
  result.upper.assign(group.begin() + 1, group.end());
  const auto is_bound = [&](const Piece& piece) {
    return std::ranges::any_of(result.lower, [&](const Piece& other) {
      return neighbours.before(piece) == neighbours.before(other) ||
             neighbours.behind(piece) == neighbours.behind(other);
    });
  };
  const auto next_bound = [&] {
    return std::find_if(result.upper.begin(), result.upper.end(), is_bound);
  };
  for (auto bound = next_bound(); bound != result.upper.end(); bound = next_bound()) {
    result.lower.push_back(*bound);
    result.upper.erase(bound);
  }
  const auto by_place = [](const Piece& a, const Piece& b) { return a.begin() < b.begin(); };
  std::sort(result.lower.begin(), result.lower.end(), by_place);
  return result;
}

bool all_may_be_stacked(const PieceGroup& group, const std::vector<Way>& ways,
                        const Neighbours& neighbours, const StackedSettings& settings) {
  const bool have_altitudes =
      std::ranges::all_of(group, [&](const Piece& piece) { return ways[piece.way].has_altitudes; });
  return !have_altitudes && std::ranges::all_of(group, [&](const Piece& piece) {
    return may_be_stacked(piece, ways[piece.way], neighbours, settings);
  });
}

}  // namespace

std::vector<PieceGroup> without_stacked(const std::vector<PieceGroup>& groups,
                                        const std::vector<Way>& ways,
                                        const StackedSettings& settings, const SamePlace& ask,
                                        std::vector<StackedPieces>& told) {
  const Neighbours neighbours(groups);
  std::vector<PieceGroup> result;
  for (const PieceGroup& group : groups) {
    PieceGroup rest = group;
    while (all_may_be_stacked(group, ways, neighbours, settings)) {
      StackedPieces stacked = parted(rest, neighbours);
      if (stacked.upper.empty()) break;
      const std::optional<bool> same =
          ask ? ask(stacked.lower.front(), stacked.upper.front()) : std::nullopt;
      if (same == true) break;
      stacked.kept_apart = !same.has_value();
      result.push_back(stacked.lower);
      rest = stacked.upper;
      told.push_back(std::move(stacked));
    }
    result.push_back(rest);
  }
  std::sort(result.begin(), result.end(), [](const PieceGroup& a, const PieceGroup& b) {
    return a.front().begin() < b.front().begin();
  });
  return result;
}

}  // namespace milepost
