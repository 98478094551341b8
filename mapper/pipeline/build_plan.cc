#include "mapper/pipeline/build_plan.h"

#include <algorithm>

#include "mapper/network/driven_line.h"
#include "mapper/pipeline/pass_choice.h"
#include "mapper/pipeline/pass_comparison.h"

namespace milepost {
namespace {

Result<std::vector<const Drive*>> by_name(const std::vector<Drive>& drives) {
  std::vector<const Drive*> sorted;
  sorted.reserve(drives.size());
  for (const Drive& drive : drives) sorted.push_back(&drive);
  std::ranges::sort(sorted, {}, &Drive::name);
  const auto twice = std::ranges::adjacent_find(sorted, {}, &Drive::name);
  if (twice == sorted.end()) return sorted;
  return Error{ErrorCode::invalid_input, "drive '" + (*twice)->name + "'",
               "two drives have this name", "give each drive.json a name of its own"};
}

StoredSegment stored_segment(const NetworkSegment& segment, const RouteLine& line,
                             const std::vector<const Drive*>& drives) {
  StoredSegment stored{segment.id, line.length_m(), {}, {}};
  for (std::size_t i = 0; i < line.vertices().size(); ++i) {
    const GeoPoint& vertex = line.vertices()[i];
    stored.vertices.push_back(
        {vertex.latitude_deg, vertex.longitude_deg, vertex.altitude_m, line.along_m()[i]});
  }
  for (const std::string& successor : segment.successors) stored.successors.push_back({successor});
  for (const Pass& pass : segment.passes)
    stored.passes.push_back({drives[pass.drive]->name, pass.from_m, pass.to_m});
  return stored;
}

// The stretches of each drive, each with the segments that take its line.
std::vector<DrivePlan> stretches_of(const std::vector<const Drive*>& drives,
                                    std::vector<NamedDrivenLines> lines,
                                    const RoadNetwork& network) {
  std::vector<DrivePlan> plans;
  for (std::size_t d = 0; d < drives.size(); ++d) {
    DrivePlan plan{drives[d], {}};
    for (std::size_t s = 0; s < lines[d].lines.size(); ++s) {
      DrivenLine& driven = lines[d].lines[s];
      std::vector<SegmentCut> cuts;
      for (const NetworkSegment& segment : network.segments) {
        const Pass& pass = segment.reference_pass();
        if (pass.drive != d || pass.stretch != s) continue;
        const AlongRange range = {pass.from_m, pass.to_m};
        cuts.push_back({segment.id, range, part_of(driven.line, range)});
      }
      std::ranges::sort(cuts, {}, [](const SegmentCut& cut) { return cut.on_stretch.from_m; });
      if (cuts.empty()) continue;
      plan.stretches.push_back({std::move(driven.frames), std::move(driven.line), std::move(cuts)});
    }
    plans.push_back(std::move(plan));
  }
  return plans;
}

}  // namespace

std::size_t DrivePlan::frames() const {
  std::size_t count = 0;
  for (const StretchPlan& stretch : stretches) count += stretch.frame_indices.size();
  return count;
}

Result<BuildPlan> plan_build(const std::vector<Drive>& drives, const BuildSettings& settings,
                             int jobs) {
  const Result<std::vector<const Drive*>> sorted = by_name(drives);
  if (!sorted) return sorted.error();
  std::vector<NamedDrivenLines> lines;
  for (const Drive* drive : *sorted) {
    DrivenLineSettings driven;
    driven.min_frame_spacing_m = settings.min_frame_spacing_m;
    Result<NamedDrivenLines> of_drive = driven_lines(*drive, driven);
    if (!of_drive) return of_drive.error();
    lines.push_back(std::move(*of_drive));
  }
  PassFrames frames(*sorted, lines, jobs);
  PassChoice choice(frames, settings);
  PassComparison comparison(frames, settings);
  NetworkSettings of_network;
  if (settings.division) of_network.junction.border = settings.division->border;
  const RoadNetwork network = road_network(
      lines, of_network, [&](const std::vector<Pass>& passes) { return choice.best(passes); },
      [&](const Pass& a, const Pass& b) { return comparison.show_the_same_road(a, b); });
  if (frames.failure()) return *frames.failure();

  BuildPlan plan;
  plan.findings = network.findings;
  plan.drives = stretches_of(*sorted, std::move(lines), network);
  for (const DrivePlan& drive : plan.drives) {
    for (const StretchPlan& stretch : drive.stretches) {
      for (const SegmentCut& cut : stretch.segments) {
        const auto segment =
            std::ranges::lower_bound(network.segments, cut.id, {}, &NetworkSegment::id);
        plan.segments.push_back(stored_segment(*segment, cut.line, *sorted));
        if (segment->is_beyond_border) plan.beyond_border.insert(cut.id);
      }
    }
  }
  std::ranges::sort(plan.segments, {}, &StoredSegment::id);
  return plan;
}

}  // namespace milepost
