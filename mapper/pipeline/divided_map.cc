#include "mapper/pipeline/divided_map.h"

#include <cmath>

#include "mapper/pipeline/layers.h"

namespace milepost {

Result<DividedMap> DividedMap::create(const BuildPlan& plan, const std::filesystem::path& map_file,
                                      const std::optional<Division>& division) {
  DividedMap map;
  std::vector<std::filesystem::path> files = {map_file};
  if (division) files.push_back(division->beyond);
  if (division && map_file.stem() == division->beyond.stem()) {
    return Error{ErrorCode::invalid_input, division->beyond.string(),
                 "both maps would have the name '" + map_file.stem().string() + "'",
                 "give the files different names: successors name the map that they are in"};
  }
  for (const std::filesystem::path& file : files) {
    Result<MapWriter> writer = MapWriter::create(file);
    if (!writer) return writer.error();
    map.sides_.push_back({std::move(*writer), {.file = file}});
  }
  if (division) map.beyond_border_ = plan.beyond_border;
  if (const Status added = map.add_segments(plan); !added.ok()) return added.error();
  for (const Side& side : map.sides_) {
    if (side.report.segments > 0) continue;
    return Error{ErrorCode::invalid_input, side.report.file.string(),
                 "all roads lie on the other side of the border",
                 "give a border between the roads, or leave it out"};
  }
  return map;
}

Status DividedMap::add_segments(const BuildPlan& plan) {
  for (StoredSegment segment : plan.segments) {
    Side& side = side_of(segment.id);
    for (Successor& successor : segment.successors) {
      const Side& there = side_of(successor.segment);
      if (&there != &side) successor.map = there.report.file.stem().string();
    }
    if (const Status added = side.writer.add_segment(segment); !added.ok()) return added;
    ++side.report.segments;
    side.report.length_m += segment.length_m;
  }
  return ok_status();
}

DividedMap::Side& DividedMap::side_of(const std::string& segment) {
  return beyond_border_.contains(segment) ? sides_.back() : sides_.front();
}

Status DividedMap::set_feature_json(const std::string& json) {
  for (Side& side : sides_) {
    if (const Status set = side.writer.set_feature_json(json); !set.ok()) return set;
  }
  return ok_status();
}

Status DividedMap::set_datum(const Datum& datum) {
  for (Side& side : sides_) {
    if (const Status set = side.writer.set_datum(datum.text()); !set.ok()) return set;
  }
  return ok_status();
}

Status DividedMap::set_mapping(const BuildPlan& plan, const MappingLog& log) {
  for (Side& side : sides_) {
    std::set<std::string> ids;
    for (const StoredSegment& segment : plan.segments) {
      if (&side_of(segment.id) == &side) ids.insert(segment.id);
    }
    const std::string document = mapping_document(log.record_of(ids));
    if (const Status set = side.writer.set_mapping_document(document); !set.ok()) return set;
  }
  return ok_status();
}

Status DividedMap::add_layer(const std::string& name, const std::string& parameters_json) {
  for (Side& side : sides_) {
    const Status added = side.writer.add_layer(name, parameters_json);
    if (!added.ok()) return added;
  }
  return ok_status();
}

Status DividedMap::set_position_errors(const BuildPlan& plan,
                                       const std::vector<PositionError>& errors) {
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const std::string& segment = plan.fused[i].id;
    Side& side = side_of(segment);
    const Status set = side.writer.set_position_error(segment, errors[i]);
    if (!set.ok()) return set;
    const double length_m = plan.fused[i].line.length_m();
    side.report.position_square_m3 += length_m * std::pow(errors[i].sigma_m.value_or(0), 2);
    if (errors[i].is_assumed) side.report.assumed_m += length_m;
  }
  return ok_status();
}

Status DividedMap::add_tile(const std::string& layer, const BuiltTile& tile) {
  Side& side = side_of(tile.segment);
  const Status added =
      side.writer.add_tile(tile.segment, layer, tile.index, tile.along, tile.items, tile.frame);
  if (!added.ok()) return added;
  ++side.report.tiles;
  if (layer != layers::kLandmarks) return ok_status();
  side.report.tracklets += tile.items;
  side.report.tracklet_bytes += tile.frame.size();
  side.report.repeated += tile.repeated;
  return ok_status();
}

Result<std::vector<MapReport>> DividedMap::finish() {
  std::vector<MapReport> reports;
  for (Side& side : sides_) {
    Result<std::string> build = side.writer.complete();
    if (!build) return build.error();
    side.report.build = *build;
    reports.push_back(side.report);
  }
  for (Side& side : sides_) {
    if (const Status published = side.writer.publish(); !published.ok()) return published.error();
  }
  return reports;
}

}  // namespace milepost
