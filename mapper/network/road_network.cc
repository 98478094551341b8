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

std::vector<Pass> passes_of(const PieceGroup& group, const std::vector<Way>& ways) {
  std::vector<Pass> passes;
  passes.reserve(group.size());
  for (const Piece& piece : group) {
    const Way& way = ways[piece.way];
    passes.push_back({way.drive, way.stretch, piece.from_m, piece.to_m});
  }
  return passes;
}

long begin_of(const Piece& piece, const Way& way) {
  return std::lround(way.begin_m + piece.from_m);
}

// The segments' ids by where their passes begin.
using IdsByBegin = std::map<Place, std::string>;

IdsByBegin ids_by_begin(const std::vector<PieceGroup>& groups,
                        const std::vector<NetworkSegment>& segments) {
  IdsByBegin ids;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (const Piece& piece : groups[i]) ids[{piece.way, piece.from_m}] = segments[i].id;
  }
  return ids;
}

std::vector<std::string> successors(const PieceGroup& group, std::size_t reference,
                                    const IdsByBegin& ids) {
  std::string own;
  std::set<std::string> others;
  for (std::size_t pass = 0; pass < group.size(); ++pass) {
    const auto next = ids.find({group[pass].way, group[pass].to_m});
    if (next == ids.end()) continue;
    if (pass == reference) own = next->second;
    others.insert(next->second);
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
                         const NetworkSettings& settings, const ChooseReference& choose_reference) {
  const std::vector<Way> ways = ways_by_name(drives);
  const CrossSections sections(ways,
                               same_road(alignments(ways, settings.alignment), settings.same_road));
  const std::vector<PieceGroup> groups =
      segmentation(ways, sections, junction_cuts(ways, sections, settings.junction));

  RoadNetwork network;
  for (const std::size_t drive : by_name(drives)) {
    std::ranges::copy(drives[drive].findings, std::back_inserter(network.findings));
  }
  for (const PieceGroup& group : groups) {
    NetworkSegment segment;
    segment.passes = passes_of(group, ways);
    segment.reference = choose_reference(segment.passes);
    const Piece& reference = group[segment.reference];
    segment.id = segment_id_of(drives[ways[reference.way].drive].name,
                               begin_of(reference, ways[reference.way]));
    network.segments.push_back(std::move(segment));
  }
  const IdsByBegin ids = ids_by_begin(groups, network.segments);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    NetworkSegment& segment = network.segments[i];
    segment.successors = successors(groups[i], segment.reference, ids);
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
