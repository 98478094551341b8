#include "mapper/network/segmentation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace milepost {
namespace {

using Index = std::size_t;

// All pieces, ordered by place.
struct CutWays {
  std::vector<Piece> pieces;
  std::vector<Piece> measured;  // the same between the cuts as measured, to be compared

  double length_m(Index piece) const { return measured[piece].to_m - measured[piece].from_m; }
  Index at(const Place& place) const {
    const auto after = std::upper_bound(
        measured.begin(), measured.end(), place,
        [](const Place& wanted, const Piece& piece) { return wanted < piece.begin(); });
    return static_cast<Index>(after - measured.begin()) - 1;
  }
};

CutWays cut_ways(const std::vector<Way>& ways, const std::vector<std::vector<Cut>>& cuts) {
  CutWays result;
  for (std::size_t way = 0; way < ways.size(); ++way) {
    Cut begin;
    const auto add_piece_to = [&](const Cut& end) {
      result.pieces.push_back({way, begin.along_m, end.along_m, end.holds});
      result.measured.push_back({way, begin.measured_m, end.measured_m, end.holds});
      begin = end;
    };
    for (const Cut& cut : cuts[way]) add_piece_to(cut);
    add_piece_to({ways[way].length_m, ways[way].length_m, true});
  }
  return result;
}

// Disjoint sets (Tarjan, 1975); the least index represents its set.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }
  Index of(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(Index a, Index b) {
    const auto [less, more] = std::minmax({of(a), of(b)});
    parent_[more] = less;
  }

 private:
  std::vector<Index> parent_;
};

// Metres of a piece beside each of the others.
std::map<Index, double> metres_beside(Index piece, const CutWays& cut,
                                      const CrossSections& sections) {
  std::map<Index, double> beside_m;
  const Piece& whole = cut.measured[piece];
  const auto metres = static_cast<std::size_t>(std::lround(whole.to_m - whole.from_m));
  for (std::size_t i = 0; i < metres; ++i) {
    const double along_m = whole.from_m + 0.5 + static_cast<double>(i);
    for (const Place& place : sections.places({whole.way, along_m})) ++beside_m[cut.at(place)];
  }
  return beside_m;
}

// The group that all pieces of a group go on in, alone; nothing if there is none.
std::optional<Index> continuation(const std::vector<PieceGroup>& groups, Index group,
                                  const std::map<Place, Index>& by_begin) {
  const auto into = by_begin.find(groups[group].front().end());
  if (into == by_begin.end() || into->second == group) return std::nullopt;
  const bool all_go_on = std::ranges::all_of(groups[group], [&](const Piece& piece) {
    const auto next = by_begin.find(piece.end());
    return !piece.end_holds && next != by_begin.end() && next->second == into->second;
  });
  const bool alone = groups[into->second].size() == groups[group].size();
  return all_go_on && alone ? std::optional(into->second) : std::nullopt;
}

// Extends each piece of a group by the one of the next group that it goes on in.
void extend(PieceGroup& group, const PieceGroup& next) {
  for (Piece& piece : group) {
    const auto on = std::ranges::find_if(next, [&](const Piece& other) {
      return other.way == piece.way && other.from_m == piece.to_m;
    });
    piece.to_m = on->to_m;
    piece.end_holds = on->end_holds;
  }
}

}  // namespace

std::vector<PieceGroup> grouped_pieces(const std::vector<Way>& ways, const CrossSections& sections,
                                       const std::vector<std::vector<Cut>>& cuts) {
  const CutWays cut = cut_ways(ways, cuts);
  Sets sets(cut.pieces.size());
  for (Index i = 0; i < cut.pieces.size(); ++i) {
    for (const auto& [other, metres] : metres_beside(i, cut, sections)) {
      if (metres > std::max(cut.length_m(i), cut.length_m(other)) / 2) sets.unite(i, other);
    }
  }
  std::map<Index, PieceGroup> by_first;
  for (Index i = 0; i < cut.pieces.size(); ++i) by_first[sets.of(i)].push_back(cut.pieces[i]);
  std::vector<PieceGroup> groups;
  groups.reserve(by_first.size());
  for (auto& entry : by_first) groups.push_back(std::move(entry.second));
  return groups;
}

std::map<Place, std::size_t> groups_by_begin(const std::vector<PieceGroup>& groups) {
  std::map<Place, Index> by_begin;
  for (Index group = 0; group < groups.size(); ++group) {
    for (const Piece& piece : groups[group]) by_begin[piece.begin()] = group;
  }
  return by_begin;
}

std::vector<PieceGroup> joined(const std::vector<PieceGroup>& groups) {
  const std::map<Place, Index> by_begin = groups_by_begin(groups);
  std::vector<std::optional<Index>> next(groups.size());
  std::vector<bool> continues_another(groups.size(), false);
  for (Index group = 0; group < groups.size(); ++group) {
    next[group] = continuation(groups, group, by_begin);
    if (next[group]) continues_another[*next[group]] = true;
  }
  std::vector<PieceGroup> result;
  for (Index group = 0; group < groups.size(); ++group) {
    if (continues_another[group]) continue;
    result.push_back(groups[group]);
    for (auto on = next[group]; on; on = next[*on]) extend(result.back(), groups[*on]);
  }
  return result;
}

}  // namespace milepost
