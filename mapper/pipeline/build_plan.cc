#include "mapper/pipeline/build_plan.h"

#include <algorithm>
#include <optional>

#include "mapper/network/driven_line.h"
#include "mapper/pipeline/pass_choice.h"
#include "mapper/pipeline/pass_comparison.h"
#include "mapper/pipeline/recordings.h"

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

// Whether a pass's landmarks are mapped.
bool is_mapped(const NetworkSegment& segment, std::size_t pass, PassPolicy policy) {
  return policy == PassPolicy::fuse || pass == segment.reference;
}

// The stretches of each drive, each with the segments that take its line and the passes that are
// mapped on it.
std::vector<DrivePlan> stretches_of(const std::vector<const Drive*>& drives,
                                    std::vector<NamedDrivenLines> lines, const RoadNetwork& network,
                                    PassPolicy policy) {
  std::vector<DrivePlan> plans;
  for (std::size_t d = 0; d < drives.size(); ++d) {
    DrivePlan plan{drives[d], {}};
    for (std::size_t s = 0; s < lines[d].lines.size(); ++s) {
      DrivenLine& driven = lines[d].lines[s];
      std::vector<SegmentCut> cuts;
      std::vector<MappedPass> passes;
      for (std::size_t i = 0; i < network.segments.size(); ++i) {
        const NetworkSegment& segment = network.segments[i];
        std::size_t mapped = 0;
        for (std::size_t p = 0; p < segment.passes.size(); ++p) {
          if (!is_mapped(segment, p, policy)) continue;
          const Pass& pass = segment.passes[p];
          const std::size_t index = mapped++;
          if (pass.drive != d || pass.stretch != s) continue;
          const AlongRange range = {pass.from_m, pass.to_m};
          const bool is_line = p == segment.reference;
          passes.push_back({i, index, range, is_line});
          if (is_line) cuts.push_back({segment.id, range, part_of(driven.line, range)});
        }
      }
      std::ranges::sort(cuts, {}, [](const SegmentCut& cut) { return cut.on_stretch.from_m; });
      std::ranges::sort(passes, {}, [](const MappedPass& pass) { return pass.on_stretch.from_m; });
      if (passes.empty()) continue;
      plan.stretches.push_back(
          {std::move(driven.frames), std::move(driven.line), std::move(cuts), std::move(passes)});
    }
    plans.push_back(std::move(plan));
  }
  return plans;
}

// The segments of the plan's drives, with their passes.
std::vector<FusedSegment> fused_segments(const std::vector<DrivePlan>& drives,
                                         const RoadNetwork& network) {
  std::vector<std::optional<RouteLine>> lines(network.segments.size());
  std::vector<std::vector<FusedSegment::PassPlace>> passes(network.segments.size());
  std::size_t stretch_index = 0;
  for (const DrivePlan& drive : drives) {
    for (const StretchPlan& stretch : drive.stretches) {
      for (const MappedPass& pass : stretch.passes) {
        auto& places = passes[pass.segment];
        places.resize(std::max(places.size(), pass.pass + 1));
        places[pass.pass] = {stretch_index, pass.on_stretch};
      }
      for (const SegmentCut& cut : stretch.segments) {
        const auto segment =
            std::ranges::lower_bound(network.segments, cut.id, {}, &NetworkSegment::id);
        lines[static_cast<std::size_t>(segment - network.segments.begin())] = cut.line;
      }
      ++stretch_index;
    }
  }
  std::vector<FusedSegment> fused;
  for (std::size_t i = 0; i < network.segments.size(); ++i)
    fused.push_back({network.segments[i].id, std::move(lines[i]).value(), std::move(passes[i])});
  return fused;
}

Result<std::vector<NamedDrivenLines>> lines_of(const std::vector<const Drive*>& drives,
                                               const BuildSettings& settings) {
  DrivenLineSettings driven;
  driven.min_frame_spacing_m = settings.min_frame_spacing_m;
  std::vector<NamedDrivenLines> lines;
  for (const Drive* drive : drives) {
    Result<NamedDrivenLines> of_drive = driven_lines(*drive, driven);
    if (!of_drive) return of_drive.error();
    lines.push_back(std::move(*of_drive));
  }
  return lines;
}

}  // namespace

std::size_t DrivePlan::frames() const {
  std::size_t count = 0;
  for (const StretchPlan& stretch : stretches) count += stretch.frame_indices.size();
  return count;
}

Result<std::vector<Finding>> line_findings(const std::vector<Drive>& drives,
                                           const BuildSettings& settings) {
  const Result<std::vector<const Drive*>> sorted = by_name(drives);
  if (!sorted) return sorted.error();
  std::vector<Finding> findings;
  const auto lines = lines_of(without_copies(*sorted, findings), settings);
  if (!lines) return lines.error();
  for (const NamedDrivenLines& of_drive : *lines)
    findings.insert(findings.end(), of_drive.findings.begin(), of_drive.findings.end());
  return findings;
}

Result<BuildPlan> plan_build(const std::vector<Drive>& drives, const BuildSettings& settings,
                             int jobs) {
  const Result<std::vector<const Drive*>> sorted = by_name(drives);
  if (!sorted) return sorted.error();
  BuildPlan plan;
  const std::vector<const Drive*> kept = without_copies(*sorted, plan.findings);
  Result<std::vector<NamedDrivenLines>> laid = lines_of(kept, settings);
  if (!laid) return laid.error();
  std::vector<NamedDrivenLines>& lines = *laid;
  PassFrames frames(kept, lines, jobs);
  PassChoice choice(frames, settings);
  PassComparison comparison(frames, settings);
  NetworkSettings of_network;
  if (settings.division) of_network.junction.border = settings.division->border;
  const RoadNetwork network = road_network(
      lines, of_network, [&](const std::vector<Pass>& passes) { return choice.best(passes); },
      [&](const Pass& a, const Pass& b) { return comparison.show_the_same_road(a, b); });
  if (frames.failure()) return *frames.failure();

  plan.findings.insert(plan.findings.end(), network.findings.begin(), network.findings.end());
  plan.drives = stretches_of(kept, std::move(lines), network, settings.passes);
  plan.fused = fused_segments(plan.drives, network);
  for (std::size_t i = 0; i < network.segments.size(); ++i) {
    const NetworkSegment& segment = network.segments[i];
    plan.segments.push_back(stored_segment(segment, plan.fused[i].line, kept));
    if (segment.is_beyond_border) plan.beyond_border.insert(segment.id);
  }
  return plan;
}

}  // namespace milepost
