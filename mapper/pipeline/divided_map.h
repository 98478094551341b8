// The map files of one build: one, or one on either side of a border.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "mapper/pipeline/build_plan.h"
#include "mapper/pipeline/layer_builder.h"
#include "mapper/pipeline/mapping_log.h"
#include "mapper/pipeline/settings.h"
#include "schema/base/result.h"
#include "schema/geo/datum.h"
#include "schema/store/map_store.h"

namespace milepost {

// What was written to one map file.
struct MapReport {
  std::filesystem::path file;
  std::string build = {};
  std::size_t segments = 0;
  double length_m = 0;
  std::size_t tiles = 0;
  std::size_t tracklets = 0;         // of the layer `tracklets`
  std::uint64_t tracklet_bytes = 0;  // of its tiles
  std::size_t repeated = 0;          // its tracklets that two drives or more saw
  double position_square_m3 = 0;     // its position errors: squares, times the length of road
  double assumed_m = 0;              // of road where they are assumed
  double sparse_m = 0;               // of road where too few landmarks are seen to localize by
};

// Each segment and its tiles go to the map on its side; successors on the other side name the other
// map. Each file appears complete or not at all, and none before all are complete.
// Not safe to use from several threads at once.
class DividedMap {
 public:
  // Adds the plan's segments. Errors: those of MapWriter; invalid_input if a border leaves a map
  // without any road.
  static Result<DividedMap> create(const BuildPlan& plan, const std::filesystem::path& map_file,
                                   const std::optional<Division>& division);

  // Errors of all below: those of MapWriter.
  Status set_feature_json(const std::string& json);
  Status set_datum(const Datum& datum);
  // Each map gets what concerns its segments. REQUIRES: the same plan.
  Status set_mapping(const BuildPlan& plan, const MappingLog& log);
  Status add_layer(const std::string& name, const std::string& parameters_json);
  // REQUIRES: the same plan, an error for each of its segments.
  Status set_position_errors(const BuildPlan& plan, const std::vector<PositionError>& errors);
  // REQUIRES: the plan has the segment; the layer was added.
  Status add_tile(const std::string& layer, const BuiltTile& tile);
  // One report for each file.
  Result<std::vector<MapReport>> finish();

 private:
  struct Side {
    MapWriter writer;
    MapReport report;
  };

  DividedMap() = default;
  Status add_segments(const BuildPlan& plan);
  Side& side_of(const std::string& segment);

  std::vector<Side> sides_;              // left of the border, then beyond it
  std::set<std::string> beyond_border_;  // ids of segments
};

}  // namespace milepost
