#include "mapper/network/road_network.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "mapper/network/cross_sections.h"
#include "mapper/network/segmentation.h"
#include "schema/base/digest.h"

namespace milepost {
namespace {

constexpr std::size_t kMaxIdLength = 64;

std::vector<std::size_t> by_name(const std::vector<NamedDrivenLines>& drives) {
  std::vector<std::size_t> order(drives.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t drive) { return drives[drive].name; });
  return order;
}

std::vector<Way> ways_by_name(const std::vector<NamedDrivenLines>& drives) {
  std::vector<Way> ways;
  for (const std::size_t drive : by_name(drives)) {
    std::ranges::move(ways_of(drives[drive], drive), std::back_inserter(ways));
  }
  return ways;
}

Pass pass_of(const Piece& piece, const std::vector<Way>& ways) {
  const Way& way = ways[piece.way];
  return {way.drive, way.stretch, piece.from_m, piece.to_m};
}

// A segment runs on beyond its cut, so that the next one, whose line may be another drive's, begins
// on it.
std::vector<Pass> passes_of(const PieceGroup& group, const std::vector<Way>& ways,
                            double overlap_m) {
  std::vector<Pass> passes;
  passes.reserve(group.size());
  for (const Piece& piece : group) {
    Pass pass = pass_of(piece, ways);
    pass.to_m = std::min(pass.to_m + overlap_m, ways[piece.way].length_m);
    passes.push_back(pass);
  }
  return passes;
}

long begin_of(const Piece& piece, const Way& way) {
  return std::lround(way.begin_m + piece.from_m);
}

Finding finding_of(const StackedPieces& stacked, const std::vector<Way>& ways,
                   const std::vector<NamedDrivenLines>& drives) {
  const auto place_of = [&](const Piece& piece) {
    const Way& way = ways[piece.way];
    return "drive '" + drives[way.drive].name + "' from metre " +
           std::to_string(begin_of(piece, way));
  };
  return {
      "stacked_roads",
      place_of(stacked.lower.front()) + " and " + place_of(stacked.upper.front()),
      0,
      stacked.lower.size(),
      "they run over " +
          std::to_string(std::lround(stacked.lower.front().to_m - stacked.lower.front().from_m)) +
          " m in one place, and no drive changes between them: " +
          (stacked.kept_apart ? "one road, or one above the other; kept apart"
                              : "by their images, one road above the other; kept apart"),
      "map them with altitudes, or with a drive that changes between them"};
}

// Whether most of a piece is right of a border.
bool is_beyond(const Piece& piece, const Way& way, const std::optional<Border>& border) {
  if (!border) return false;
  const std::size_t middle = nearest_state(way, (piece.from_m + piece.to_m) / 2);
  return !border->has_left(way.states[middle].position_m);
}

// The ids of the segments in which a group's pieces go on.
std::vector<std::string> successors(const PieceGroup& group, std::size_t reference,
                                    const std::map<Place, std::size_t>& by_begin,
                                    const std::vector<NetworkSegment>& segments) {
  std::string own;
  std::set<std::string> others;
  for (std::size_t pass = 0; pass < group.size(); ++pass) {
    const auto next = by_begin.find(group[pass].end());
    if (next == by_begin.end()) continue;
    if (pass == reference) own = segments[next->second].id;
    others.insert(segments[next->second].id);
  }
  others.erase(own);
  std::vector<std::string> found(others.begin(), others.end());
  if (!own.empty()) found.insert(found.begin(), own);
  return found;
}

}  // namespace

std::size_t first_pass(const std::vector<Pass>& /*passes*/) { return 0; }

std::string segment_id_of(const std::string& drive_name, long metre) {
  const std::string suffix = "-" + std::to_string(metre);
  if (drive_name.size() + suffix.size() <= kMaxIdLength) return drive_name + suffix;
  const std::string digest = "." + digest_of(as_bytes(drive_name)).substr(0, 8);
  return drive_name.substr(0, kMaxIdLength - suffix.size() - digest.size()) + digest + suffix;
}

RoadNetwork road_network(const std::vector<NamedDrivenLines>& drives,
                         const NetworkSettings& settings, const ChooseReference& choose_reference,
                         const SameRoadByImages& same_road_by_images) {
  const std::vector<Way> ways = ways_by_name(drives);
  const CrossSections sections(ways,
                               same_road(alignments(ways, settings.alignment), settings.same_road));
  SamePlace ask;
  if (same_road_by_images) {
    ask = [&](const Piece& a, const Piece& b) {
      return same_road_by_images(pass_of(a, ways), pass_of(b, ways));
    };
  }
  std::vector<StackedPieces> stacked;
  const std::vector<PieceGroup> groups = joined(without_stacked(
      joined(grouped_pieces(ways, sections, junction_cuts(ways, sections, settings.junction))),
      ways, settings.stacked, ask, stacked));

  RoadNetwork network;
  for (const std::size_t drive : by_name(drives)) {
    std::ranges::copy(drives[drive].findings, std::back_inserter(network.findings));
  }
  for (const StackedPieces& pieces : stacked) {
    network.findings.push_back(finding_of(pieces, ways, drives));
  }
  for (const PieceGroup& group : groups) {
    NetworkSegment segment;
    segment.passes = passes_of(group, ways, settings.overlap_m);
    segment.reference = choose_reference(segment.passes);
    const Piece& reference = group[segment.reference];
    segment.id = segment_id_of(drives[ways[reference.way].drive].name,
                               begin_of(reference, ways[reference.way]));
    segment.is_beyond_border = is_beyond(reference, ways[reference.way], settings.junction.border);
    network.segments.push_back(std::move(segment));
  }
  const std::map<Place, std::size_t> by_begin = groups_by_begin(groups);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    NetworkSegment& segment = network.segments[i];
    segment.successors = successors(groups[i], segment.reference, by_begin, network.segments);
  }
  std::ranges::sort(network.segments, {}, &NetworkSegment::id);
  return network;
}

PassLine line_of(const Pass& pass, const RouteLine& driven) {
  constexpr double kDistinctM = 1e-3;  // a vertex nearer to a cut is left out
  PassLine line;
  const auto add = [&line](const GeoPoint& point, double along_m) {
    line.vertices.push_back(point);
    line.along_m.push_back(along_m);
  };
  add(driven.point_at(pass.from_m), 0);
  for (std::size_t i = 0; i < driven.vertices().size(); ++i) {
    const double along_m = driven.along_m()[i];
    const bool inside = along_m > pass.from_m + kDistinctM && along_m < pass.to_m - kDistinctM;
    if (inside) add(driven.vertices()[i], along_m - pass.from_m);
  }
  add(driven.point_at(pass.to_m), pass.to_m - pass.from_m);
  return line;
}

}  // namespace milepost
