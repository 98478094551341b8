// Everything that the report of a map shows (milepost-mapper report), as values.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapper/inspect/inspection.h"
#include "mapper/report/segment_stretches.h"
#include "schema/base/result.h"
#include "schema/document/mapping_record.h"
#include "schema/geo/geodesy.h"
#include "schema/geo/route_line.h"
#include "schema/store/map_store.h"

namespace milepost {

struct SegmentReport {
  SegmentInspection inspected;
  RouteLine line;
  std::vector<MapStretch> stretches;  // one or more
};

// One value per landmark.
struct LandmarkFigures {
  std::vector<double> drives;      // that saw it
  std::vector<double> track_m;     // between its first and last observation
  std::vector<double> distance_m;  // from where it was mapped
};

// What the map tells of a drive, and what was recorded of its images when the map was built.
struct MappedDrive {
  std::string name;
  std::size_t passes = 0;  // over segments
  double length_m = 0;     // of these segments
  std::optional<PoseFit> fit = {};
};

struct MapReportData {
  MapInspection map;                    // its segments have moved to `segments`
  std::vector<SegmentReport> segments;  // by id
  LandmarkFigures landmarks;
  std::vector<double> tile_kb_per_m;  // of the default method, a value a tile
  std::vector<MappedDrive> drives;    // by name
  std::optional<std::vector<RecordedFinding>> findings = {};  // none: not recorded
  std::vector<CheckPointResidual> check_points = {};          // as recorded
  GeoPoint centre;                                            // of the map; the plan's origin

  double length_m() const;
  std::uint64_t landmark_count() const;
};

// Reads all tiles of the default method. Errors: those of MapReader; corrupt (a tile, a line or
// the parameters of the layer).
Result<MapReportData> map_report_data(const MapReader& map,
                                      const std::optional<MappingRecord>& record);

}  // namespace milepost
