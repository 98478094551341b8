#include "client/evaluate/roads_around.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

namespace milepost {
namespace {

constexpr double kNearM = 150;       // from the drive
constexpr double kReadEveryM = 100;  // of the drive, all within it and kNearM

std::set<SegmentKey> segments_with_a_fix(const std::vector<MethodEvaluation>& methods) {
  std::set<SegmentKey> segments;
  for (const MethodEvaluation& method : methods) {
    for (const EvaluatedFix& evaluated : method.fixes) {
      const Fix& fix = evaluated.frame.fix;
      if (fix.along_m) segments.insert({fix.version, fix.segment});
    }
  }
  return segments;
}

Result<std::set<SegmentKey>> segments_beside(const Drive& drive, MapSource& source) {
  std::set<SegmentKey> segments;
  std::optional<GeoPoint> read_at;
  for (const Frame& frame : drive.frames) {
    if (!is_valid(frame.position)) continue;
    if (read_at && geodesic_distance_m(*read_at, frame.position) < kReadEveryM) continue;
    read_at = frame.position;
    const auto near = source.segments_near(frame.position, kNearM + kReadEveryM);
    if (!near) return near.error();
    for (const NearbySegment& segment : *near) segments.insert({segment.version, segment.segment});
  }
  return segments;
}

}  // namespace

Result<std::vector<RoadAround>> roads_around(const Drive& drive,
                                             const std::vector<MethodEvaluation>& methods,
                                             MapSource& source) {
  const std::set<SegmentKey> driven = segments_with_a_fix(methods);
  Result<std::set<SegmentKey>> all = segments_beside(drive, source);
  if (!all) return all.error();
  all->insert(driven.begin(), driven.end());
  std::vector<RoadAround> roads;
  std::map<std::pair<std::string, std::string>, int> predecessors;  // by map and segment
  for (const SegmentKey& key : *all) {
    const Result<SegmentDescription> segment = source.segment(key.version, key.segment);
    if (!segment && !driven.contains(key)) continue;  // not drawn; the evaluation needs no more
    if (!segment) return segment.error();
    for (const Successor& next : segment->successors) ++predecessors[{next.map, next.segment}];
    roads.push_back({key, segment->length_m, segment->vertices, driven.contains(key), false,
                     segment->successors.size() > 1});
  }
  for (RoadAround& road : roads) {
    const auto leading_here = predecessors.find({road.segment.version.map, road.segment.segment});
    road.begins_at_junction = leading_here != predecessors.end() && leading_here->second > 1;
  }
  return roads;
}

}  // namespace milepost
