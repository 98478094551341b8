#include "mapper/network/junctions.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <tuple>

namespace milepost {
namespace {

constexpr double kSameVisitM = 20;  // a way's changes farther apart are of two visits to a junction

// Where the set of passes changes, or must be taken to.
struct Change {
  Place place;
  bool holds = false;
};

// Whether each place of one cross-section goes on as one of another, a metre away.
bool all_occur(const std::vector<Place>& places, const std::vector<Place>& others) {
  return std::ranges::all_of(places, [&](const Place& place) {
    return std::ranges::any_of(others, [&](const Place& other) {
      return other.way == place.way && std::abs(other.along_m - place.along_m) < kSameVisitM / 2;
    });
  });
}

bool same_passes(const std::vector<Place>& a, const std::vector<Place>& b) {
  return all_occur(a, b) && all_occur(b, a);
}

bool holds_change(const std::vector<Change>& changes, const AlongRange& range) {
  return std::ranges::any_of(
      changes, [&](const Change& change) { return range.contains(change.place.along_m); });
}

void add_changes(std::size_t index, const Way& way, const CrossSections& sections,
                 const UTurnSettings& settings, std::vector<Change>& changes) {
  const std::size_t first_change = changes.size();
  changes.push_back({{index, 0}});
  std::vector<Place> places = sections.places({index, 0});
  for (std::size_t i = 0; i + 1 < way.states.size(); ++i) {
    const auto along_m = static_cast<double>(i);
    std::vector<Place> further = sections.places({index, along_m + 1});
    if (!same_passes(places, further)) changes.push_back({{index, along_m + 0.5}});
    places = std::move(further);
  }
  const std::vector<Change> passes_change(
      changes.begin() + static_cast<std::ptrdiff_t>(first_change), changes.end());
  for (const AlongRange& arc : u_turns(way, settings)) {
    const AlongRange before{arc.from_m - settings.max_approach_m, arc.from_m};
    const AlongRange after{arc.to_m, arc.to_m + settings.max_approach_m};
    if (!holds_change(passes_change, before)) changes.push_back({{index, arc.from_m}, true});
    if (!holds_change(passes_change, after)) changes.push_back({{index, arc.to_m}, true});
  }
  changes.push_back({{index, way.length_m}});
  std::stable_sort(changes.begin() + static_cast<std::ptrdiff_t>(first_change), changes.end(),
                   [](const Change& a, const Change& b) { return a.place < b.place; });
}

// Where a way crosses a border: the last change of sides before it is clearly on the other.
std::vector<double> crossings_m(const Way& way, const Border& border, double clearly_m) {
  std::vector<double> found;
  std::optional<bool> was_left;
  double changed_m = 0;
  for (std::size_t i = 0; i < way.states.size(); ++i) {
    const double left_m = border.left_m(way.states[i].position_m);
    const bool is_left = left_m > 0;
    const bool changes = i > 0 && border.has_left(way.states[i - 1].position_m) != is_left;
    if (changes) changed_m = static_cast<double>(i) - 0.5;
    if (std::abs(left_m) < clearly_m) continue;
    if (was_left && *was_left != is_left) found.push_back(changed_m);
    was_left = is_left;
  }
  return found;
}

// The changes within some reach of a place, on its way.
std::vector<std::size_t> changes_near(const Place& place, const std::vector<Change>& changes,
                                      double reach_m) {
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const Place& other = changes[i].place;
    if (other.way == place.way && std::abs(other.along_m - place.along_m) <= reach_m)
      near.push_back(i);
  }
  return near;
}

// Cuts a road where its first way crosses the border, all of its ways on one cross-section. Near a
// change, the road is cut there instead.
void add_border(const std::vector<Way>& ways, const CrossSections& sections, const Border& border,
                double reach_m, std::vector<Change>& changes) {
  for (std::size_t index = 0; index < ways.size(); ++index) {
    for (const double crossing_m : crossings_m(ways[index], border, reach_m)) {
      const std::vector<Place> places = sections.places({index, crossing_m});
      std::vector<std::size_t> near;
      for (const Place& place : places)
        std::ranges::copy(changes_near(place, changes, reach_m), std::back_inserter(near));
      for (const std::size_t change : near) changes[change].holds = true;
      if (!near.empty()) continue;
      for (const Place& place : places) changes.push_back({place, true});
    }
  }
  std::stable_sort(changes.begin(), changes.end(),
                   [](const Change& a, const Change& b) { return a.place < b.place; });
}

// Two changes, by their indices, and how far apart they are along the road.
struct Pair {
  double apart_m = 0;
  std::size_t a = 0, b = 0;

  friend bool operator<(const Pair& x, const Pair& y) {
    return std::tie(x.apart_m, x.a, x.b) < std::tie(y.apart_m, y.a, y.b);
  }
};

// Groups changes on all ways into junctions: agglomerative clustering with complete linkage, so
// that a row of changes does not grow into one junction. Ascending distance decides, not order.
class JunctionClusters {
 public:
  JunctionClusters(std::vector<Change> changes, const CrossSections& sections, double radius_m)
      : changes_(std::move(changes)), diameter_m_(2 * radius_m) {
    clusters_.resize(changes_.size());
    cluster_of_.resize(changes_.size());
    std::iota(cluster_of_.begin(), cluster_of_.end(), std::size_t{0});
    for (std::size_t i = 0; i < changes_.size(); ++i) clusters_[i] = {i};
    for (const Pair& pair : pairs(sections)) {
      unite(cluster_of_[pair.a], cluster_of_[pair.b]);
    }
  }

  // One for each visit of a way to a junction.
  std::vector<Change> means() const {
    std::vector<Change> found;
    for (const std::vector<std::size_t>& cluster : clusters_) {
      for (std::size_t i = 0; i < cluster.size();) {
        const std::size_t end = visit_end(cluster, i);
        found.push_back(mean_of(cluster, i, end));
        i = end;
      }
    }
    return found;
  }

 private:
  // Changes on one cross-section, or near it, as each of their ways measures it.
  std::vector<Pair> pairs(const CrossSections& sections) const {
    std::vector<Pair> found;
    for (std::size_t i = 0; i < changes_.size(); ++i) {
      for (const double side_m : {-0.5, 0.5}) {
        Place beside = changes_[i].place;
        beside.along_m = std::max(0.0, beside.along_m + side_m);
        for (Place place : sections.places(beside)) {
          place.along_m -= side_m;
          add_pairs(i, place, found);
        }
      }
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  void add_pairs(std::size_t i, const Place& place, std::vector<Pair>& found) const {
    const Place from{place.way, place.along_m - diameter_m_};
    auto other = std::lower_bound(
        changes_.begin(), changes_.end(), from,
        [](const Change& change, const Place& wanted) { return change.place < wanted; });
    for (; other != changes_.end() && other->place.way == place.way; ++other) {
      const double apart_m = std::abs(other->place.along_m - place.along_m);
      if (other->place.along_m > place.along_m + diameter_m_) break;
      const auto j = static_cast<std::size_t>(other - changes_.begin());
      if (j != i) found.push_back({apart_m, std::min(i, j), std::max(i, j)});
    }
  }

  void unite(std::size_t a, std::size_t b) {
    if (a == b) return;
    std::vector<std::size_t> both;
    std::ranges::merge(clusters_[a], clusters_[b], std::back_inserter(both));
    if (!fits_a_junction(both)) return;
    for (const std::size_t i : clusters_[b]) cluster_of_[i] = a;
    clusters_[a] = std::move(both);
    clusters_[b].clear();
  }

  bool fits_a_junction(const std::vector<std::size_t>& cluster) const {
    for (std::size_t i = 0; i < cluster.size();) {
      const std::size_t end = visit_end(cluster, i);
      if (along_m(cluster[end - 1]) - along_m(cluster[i]) > diameter_m_) return false;
      i = end;
    }
    return true;
  }

  // Changes are in the order of places, so those of one visit follow each other.
  std::size_t visit_end(const std::vector<std::size_t>& cluster, std::size_t first) const {
    std::size_t end = first + 1;
    while (end < cluster.size() &&
           changes_[cluster[end]].place.way == changes_[cluster[first]].place.way &&
           along_m(cluster[end]) - along_m(cluster[end - 1]) < kSameVisitM) {
      ++end;
    }
    return end;
  }

  Change mean_of(const std::vector<std::size_t>& cluster, std::size_t first,
                 std::size_t end) const {
    Change mean = changes_[cluster[first]];
    double sum_m = 0;
    for (std::size_t i = first; i < end; ++i) {
      sum_m += along_m(cluster[i]);
      mean.holds = mean.holds || changes_[cluster[i]].holds;
    }
    mean.place.along_m = sum_m / static_cast<double>(end - first);
    return mean;
  }

  double along_m(std::size_t change) const { return changes_[change].place.along_m; }

  std::vector<Change> changes_;  // ordered by place
  double diameter_m_;
  std::vector<std::vector<std::size_t>> clusters_;  // of indices of changes, ascending
  std::vector<std::size_t> cluster_of_;
};

// Adds a cut at the nearest multiple of the grid, unless it is near an end. Two at one place are
// one.
void add_cut(const Change& change, const Way& way, const JunctionSettings& settings,
             std::vector<Cut>& cuts) {
  const double measured_m = change.place.along_m;
  const double along_m =
      std::round((way.begin_m + measured_m) / settings.grid_m) * settings.grid_m - way.begin_m;
  const bool inside =
      along_m >= settings.min_segment_m && along_m <= way.length_m - settings.min_segment_m;
  if (!inside) return;
  if (!cuts.empty() && cuts.back().along_m >= along_m) {
    cuts.back().holds = cuts.back().holds || change.holds;
  } else {
    cuts.push_back({measured_m, along_m, change.holds});
  }
}

}  // namespace

std::vector<std::vector<Cut>> junction_cuts(const std::vector<Way>& ways,
                                            const CrossSections& sections,
                                            const JunctionSettings& settings) {
  std::vector<Change> changes;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    add_changes(i, ways[i], sections, settings.u_turn, changes);
  }
  if (settings.border)
    add_border(ways, sections, *settings.border, settings.border_reach_m, changes);
  std::vector<Change> means =
      JunctionClusters(std::move(changes), sections, settings.radius_m).means();
  std::stable_sort(means.begin(), means.end(),
                   [](const Change& a, const Change& b) { return a.place < b.place; });
  std::vector<std::vector<Cut>> cuts(ways.size());
  for (const Change& mean : means) {
    add_cut(mean, ways[mean.place.way], settings, cuts[mean.place.way]);
  }
  return cuts;
}

}  // namespace milepost
