#include "mapper/network/segmentation.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace milepost {
namespace {

using Index = std::size_t;
constexpr Index kNone = static_cast<Index>(-1);

// All pieces, ordered: consecutive ones of a way follow each other.
struct CutWays {
  std::vector<Piece> pieces;
  std::vector<bool> cut_holds;  // by piece: that at its end

  bool goes_on(Index piece) const {
    return piece + 1 < pieces.size() && pieces[piece + 1].way == pieces[piece].way;
  }
  Index at(const Place& place) const {
    const auto after = std::upper_bound(pieces.begin(), pieces.end(), place,
                                        [](const Place& wanted, const Piece& piece) {
                                          return wanted < Place{piece.way, piece.from_m};
                                        });
    return static_cast<Index>(after - pieces.begin()) - 1;
  }
};

CutWays cut_ways(const std::vector<Way>& ways, const std::vector<std::vector<Cut>>& cuts) {
  CutWays result;
  for (std::size_t way = 0; way < ways.size(); ++way) {
    double from_m = 0;
    for (const Cut& cut : cuts[way]) {
      result.pieces.push_back({way, from_m, cut.along_m});
      result.cut_holds.push_back(cut.holds);
      from_m = cut.along_m;
    }
    result.pieces.push_back({way, from_m, ways[way].length_m});
    result.cut_holds.push_back(true);
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
  // The members of each set in ascending order, the sets by their first members.
  std::vector<std::vector<Index>> members() {
    std::map<Index, std::vector<Index>> by_first;
    for (Index i = 0; i < parent_.size(); ++i) by_first[of(i)].push_back(i);
    std::vector<std::vector<Index>> result;
    result.reserve(by_first.size());
    for (auto& entry : by_first) result.push_back(std::move(entry.second));
    return result;
  }

 private:
  std::vector<Index> parent_;
};

// Metres of a piece beside each of the others.
std::map<Index, double> metres_beside(Index piece, const CutWays& cut,
                                      const CrossSections& sections) {
  std::map<Index, double> beside_m;
  const Piece& whole = cut.pieces[piece];
  for (double along_m = whole.from_m + 0.5; along_m < whole.to_m; ++along_m) {
    for (const Place& place : sections.places({whole.way, along_m})) ++beside_m[cut.at(place)];
  }
  return beside_m;
}

std::vector<std::vector<Index>> groups_beside(const CutWays& cut, const CrossSections& sections) {
  const auto length_m = [&](Index i) { return cut.pieces[i].to_m - cut.pieces[i].from_m; };
  Sets sets(cut.pieces.size());
  for (Index i = 0; i < cut.pieces.size(); ++i) {
    for (const auto& [other, metres] : metres_beside(i, cut, sections)) {
      if (metres > std::max(length_m(i), length_m(other)) / 2) sets.unite(i, other);
    }
  }
  return sets.members();
}

// For each group the one that all of its pieces go on in, and no others; kNone where there is none.
std::vector<Index> continuations(const CutWays& cut,
                                 const std::vector<std::vector<Index>>& groups) {
  std::vector<Index> group_of(cut.pieces.size());
  for (Index group = 0; group < groups.size(); ++group) {
    for (const Index piece : groups[group]) group_of[piece] = group;
  }
  std::vector<Index> next(groups.size(), kNone);
  for (Index group = 0; group < groups.size(); ++group) {
    const std::vector<Index>& pieces = groups[group];
    if (!cut.goes_on(pieces.front())) continue;
    const Index into = group_of[pieces.front() + 1];
    const bool all_go_on = std::ranges::all_of(pieces, [&](Index piece) {
      return cut.goes_on(piece) && !cut.cut_holds[piece] && group_of[piece + 1] == into;
    });
    if (all_go_on && into != group && groups[into].size() == pieces.size()) next[group] = into;
  }
  return next;
}

// Joins each piece of a chain of groups with those that it goes on in.
PieceGroup joined(const CutWays& cut, const std::vector<Index>& pieces, std::size_t chain_length) {
  PieceGroup group;
  for (const Index piece : pieces) {
    const Piece& first = cut.pieces[piece];
    group.push_back({first.way, first.from_m, cut.pieces[piece + chain_length - 1].to_m});
  }
  return group;
}

}  // namespace

std::vector<PieceGroup> segmentation(const std::vector<Way>& ways, const CrossSections& sections,
                                     const std::vector<std::vector<Cut>>& cuts) {
  const CutWays cut = cut_ways(ways, cuts);
  const std::vector<std::vector<Index>> groups = groups_beside(cut, sections);
  const std::vector<Index> next = continuations(cut, groups);
  std::vector<bool> is_continuation(groups.size(), false);
  for (const Index into : next) {
    if (into != kNone) is_continuation[into] = true;
  }
  std::vector<PieceGroup> result;
  for (Index group = 0; group < groups.size(); ++group) {
    if (is_continuation[group]) continue;
    std::size_t chain_length = 1;
    for (Index last = group; next[last] != kNone; last = next[last]) ++chain_length;
    result.push_back(joined(cut, groups[group], chain_length));
  }
  return result;
}

}  // namespace milepost
