#include "mapper/report/map_report_data.h"

#include <algorithm>
#include <map>
#include <utility>

#include <nlohmann/json.hpp>

#include "schema/base/json.h"
#include "schema/tile/codec.h"
#include "schema/tile/layer_parameters.h"

namespace milepost {
namespace {

// Of the default method's tiles.
struct TileParameters {
  double tile_length_m = 0;
  double focal_px = 0;
};

Result<TileParameters> tile_parameters(const MapReader& map) {
  const std::string& text = map.layers().at(layers::kLandmarks);
  const Result<nlohmann::json> json = read_json(text);
  const Result<LayerParameters> read = json ? layer_parameters_from_json(*json) : json.error();
  if (!read) {
    return Error{ErrorCode::corrupt, map.file().string() + ", layer " + layers::kLandmarks,
                 read.error().what, read.error().hint};
  }
  const auto length = json->find("tile_length_m");
  const bool is_there = length != json->end() && length->is_number();
  return TileParameters{is_there ? length->get<double>() : 0, read->focal_px()};
}

Result<RouteLine> line_of(const MapReader& map, const StoredSegment& segment) {
  std::vector<GeoPoint> vertices;
  for (const StoredVertex& vertex : segment.vertices)
    vertices.push_back({vertex.latitude_deg, vertex.longitude_deg, vertex.altitude_m});
  Result<RouteLine> line = RouteLine::from_vertices(std::move(vertices));
  if (line) return line;
  Error error = line.error();
  error.code = ErrorCode::corrupt;
  error.where = map.file().string() + ", segment " + segment.id;
  return error;
}

// The metres of a segment on which the first observations of a tile lie.
double length_of(const TileEntry& entry, double tile_length_m, double segment_length_m) {
  const double from_m = entry.index * tile_length_m;
  return std::min(from_m + tile_length_m, segment_length_m) - from_m;
}

Result<std::vector<PlacedLandmark>> landmarks_on(const MapReader& map, const std::string& segment,
                                                 const RouteLine& line,
                                                 const TileParameters& parameters,
                                                 MapReportData& data) {
  constexpr double kLeastM = 5;  // the rest of a tile at a segment's end says little
  const auto index = map.tile_index(segment, layers::kLandmarks);
  if (!index) return index.error();
  std::vector<PlacedLandmark> all;
  for (const TileEntry& entry : *index) {
    const auto frame = map.tile(segment, layers::kLandmarks, entry);
    if (!frame) return frame.error();
    const auto tile = decode_landmarks(*frame);
    if (!tile) return tile.error();
    const std::vector<PlacedLandmark> of_tile = placed(*tile, line);
    all.insert(all.end(), of_tile.begin(), of_tile.end());
    const double on_m = length_of(entry, parameters.tile_length_m, line.length_m());
    if (on_m >= kLeastM)
      data.tile_kb_per_m.push_back(static_cast<double>(entry.bytes) / 1000 / on_m);
  }
  return all;
}

void add_figures(const std::vector<PlacedLandmark>& landmarks, LandmarkFigures& figures) {
  for (const PlacedLandmark& each : landmarks) {
    figures.drives.push_back(each.landmark.passes);
    figures.track_m.push_back(each.landmark.along.to_m - each.landmark.along.from_m);
    figures.distance_m.push_back(each.distance_m);
  }
}

std::vector<MappedDrive> drives_of(const std::vector<SegmentReport>& segments,
                                   const std::optional<MappingRecord>& record) {
  std::map<std::string, MappedDrive> drives;
  for (const SegmentReport& segment : segments) {
    for (const StoredPass& pass : segment.inspected.stored.passes) {
      MappedDrive& drive = drives[pass.drive];
      ++drive.passes;
      drive.length_m += segment.inspected.stored.length_m;
    }
  }
  if (record) {
    for (const DriveFit& each : record->drives) drives[each.drive].fit = each.fit;
  }
  std::vector<MappedDrive> all;
  for (auto& [name, drive] : drives) {
    drive.name = name;
    all.push_back(std::move(drive));
  }
  return all;
}

// The middle of the lines' extent, in a frame that knows no longitude 180.
GeoPoint centre_of(const std::vector<SegmentReport>& segments) {
  if (segments.empty()) return {};
  const LocalFrame frame(segments.front().line.vertices().front());
  EnuPoint least = frame.enu_from_geo(segments.front().line.vertices().front());
  EnuPoint most = least;
  for (const SegmentReport& segment : segments) {
    for (const GeoPoint& vertex : segment.line.vertices()) {
      const EnuPoint at = frame.enu_from_geo(vertex);
      least = {std::min(least.east_m, at.east_m), std::min(least.north_m, at.north_m), 0};
      most = {std::max(most.east_m, at.east_m), std::max(most.north_m, at.north_m), 0};
    }
  }
  return frame.geo_from_enu(
      {(least.east_m + most.east_m) / 2, (least.north_m + most.north_m) / 2, 0});
}

Result<SegmentReport> segment_report(const MapReader& map, SegmentInspection inspected,
                                     const std::optional<TileParameters>& parameters,
                                     const std::optional<MappingRecord>& record,
                                     MapReportData& data) {
  const std::string& id = inspected.stored.id;
  Result<RouteLine> line = line_of(map, inspected.stored);
  if (!line) return line.error();
  std::vector<PlacedLandmark> landmarks;
  if (parameters) {
    auto found = landmarks_on(map, id, *line, *parameters, data);
    if (!found) return found.error();
    landmarks = std::move(*found);
    add_figures(landmarks, data.landmarks);
  }
  std::vector<StretchFit> fits;
  if (record) {
    const auto of_segment = record->segments.find(id);
    if (of_segment != record->segments.end()) fits = of_segment->second;
  }
  std::vector<MapStretch> stretches =
      stretches_of({inspected.stored, *line, landmarks, inspected.gaps, fits,
                    parameters ? parameters->focal_px : 1});
  return SegmentReport{std::move(inspected), std::move(*line), std::move(stretches)};
}

}  // namespace

double MapReportData::length_m() const {
  double sum_m = 0;
  for (const SegmentReport& segment : segments) sum_m += segment.inspected.stored.length_m;
  return sum_m;
}

std::uint64_t MapReportData::landmark_count() const {
  std::uint64_t sum = 0;
  for (const SegmentReport& segment : segments) sum += segment.inspected.landmarks;
  return sum;
}

Result<MapReportData> map_report_data(const MapReader& map,
                                      const std::optional<MappingRecord>& record) {
  Result<MapInspection> inspected = inspect(map);
  if (!inspected) return inspected.error();
  MapReportData data;
  data.map = std::move(*inspected);
  std::optional<TileParameters> parameters;
  if (map.layers().contains(layers::kLandmarks)) {
    Result<TileParameters> read = tile_parameters(map);
    if (!read) return read.error();
    parameters = *read;
  }
  for (SegmentInspection& segment : std::exchange(data.map.segments, {})) {
    Result<SegmentReport> report =
        segment_report(map, std::move(segment), parameters, record, data);
    if (!report) return report.error();
    data.segments.push_back(std::move(*report));
  }
  data.drives = drives_of(data.segments, record);
  if (record) {
    data.findings = record->findings;
    data.check_points = record->check_points;
  }
  data.centre = centre_of(data.segments);
  return data;
}

}  // namespace milepost
