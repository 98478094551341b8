#include "client/fetch/file_source.h"

#include <mutex>
#include <optional>
#include <utility>

#include "client/fetch/cell_request.h"
#include "client/fetch/documents.h"
#include "client/fetch/nearby.h"
#include "schema/base/json.h"
#include "schema/store/map_store.h"

namespace milepost {
namespace {

SegmentDescription description_of(const StoredSegment& stored, const std::string& map) {
  SegmentDescription description{stored.id,         stored.length_m, {},
                                 stored.successors, stored.passes,   stored.position_error};
  for (Successor& successor : description.successors) {
    if (successor.map.empty()) successor.map = map;
  }
  for (const StoredVertex& vertex : stored.vertices) {
    description.vertices.push_back({vertex.latitude_deg, vertex.longitude_deg, vertex.altitude_m});
  }
  return description;
}

// Parses parameters from a JSON object that the map file stores as text.
template <class Parameters>
Result<Parameters> parameters_from(const std::string& text,
                                   Result<Parameters> (*from_json)(const nlohmann::json&)) {
  const Result<nlohmann::json> json = read_json(text);
  if (json) return from_json(*json);
  Error error = json.error();
  error.hint = "build the map anew";
  return error;
}

MapDescription description_of(const MapReader& reader) {
  MapDescription description;
  description.version = {reader.file().stem().string(), reader.build()};
  for (const auto& [name, parameters] : reader.layers()) {
    description.layers.emplace(name, parameters_from(parameters, layer_parameters_from_json));
  }
  description.feature = parameters_from(reader.feature_json(), feature_parameters_from_json);
  description.bounds = reader.bounds();
  if (Result<Datum> datum = Datum::from(reader.datum())) description.datum = std::move(*datum);
  return description;
}

// The state shared by all sources of one file.
struct OpenFile {
  explicit OpenFile(MapReader opened)
      : reader(std::move(opened)), description(description_of(reader)) {}

  std::mutex mutex;  // guards `reader` and `lines`
  MapReader reader;
  const MapDescription description;
  std::optional<std::vector<KnownLine>> lines;
};

class FileSource : public MapSource {
 public:
  explicit FileSource(std::shared_ptr<OpenFile> file, Stopped stopped = {})
      : file_(std::move(file)), stopped_(std::move(stopped)) {}

  Result<std::vector<NearbySegment>> segments_near(const GeoPoint& position,
                                                   double radius_m) override {
    const std::lock_guard lock(file_->mutex);
    Status ready = check_near_query(position, radius_m);
    if (ready.ok()) ready = load_lines();
    if (!ready.ok()) return ready.error();
    return lines_near(*file_->lines, position, radius_m);
  }

  Result<std::vector<MapVersion>> maps() override {
    return std::vector<MapVersion>{file_->description.version};
  }

  Result<MapDescription> describe(const MapVersion& version) override {
    const std::lock_guard lock(file_->mutex);
    const Status checked = check(version);
    if (!checked.ok()) return checked.error();
    return file_->description;
  }

  Result<SegmentDescription> segment(const MapVersion& version,
                                     const std::string& segment) override {
    const std::lock_guard lock(file_->mutex);
    const Status checked = check(version);
    if (!checked.ok()) return checked.error();
    const Result<StoredSegment> stored = file_->reader.segment(segment);
    if (!stored.ok()) return stored.error();
    return description_of(*stored, version.map);
  }

  Result<std::vector<EncodedTile>> tiles(const MapVersion& version, const std::string& segment,
                                         const std::string& layer,
                                         const AlongRange& range) override {
    const std::lock_guard lock(file_->mutex);
    const Status checked = check(version);
    if (!checked.ok()) return checked.error();
    const auto entries = file_->reader.tiles_in(segment, layer, range);
    if (!entries.ok()) return entries.error();
    std::vector<EncodedTile> tiles;
    for (const TileEntry& entry : *entries) {
      if (is_stopped(stopped_)) return cancelled(file_->reader.file().string());
      Result<Bytes> tile = file_->reader.tile(segment, layer, entry);
      if (!tile.ok()) return tile.error();
      tiles.push_back({entry.index, std::move(tile).value()});
    }
    return tiles;
  }

  Result<std::vector<EncodedCell>> cells(const MapVersion& version, const std::string& layer,
                                         const Bounds& box) override {
    const std::lock_guard lock(file_->mutex);
    Status checked = check_area_query(box);
    if (checked.ok()) checked = check(version);
    if (!checked.ok()) return checked.error();
    const auto entries = file_->reader.cells_in(layer, box);
    if (!entries.ok()) return entries.error();
    std::vector<EncodedCell> tiles;
    for (const CellEntry& entry : *entries) {
      if (is_stopped(stopped_)) return cancelled(file_->reader.file().string());
      Result<Bytes> tile = file_->reader.cell(layer, entry);
      if (!tile.ok()) return tile.error();
      tiles.push_back({entry.cell, std::move(tile).value()});
    }
    return tiles;
  }

  Result<std::uint64_t> layer_bytes(const MapVersion& version, const std::string& segment,
                                    const std::string& layer) override {
    const std::lock_guard lock(file_->mutex);
    const Status checked = check(version);
    if (!checked.ok()) return checked.error();
    const auto index = file_->reader.tile_index(segment, layer);
    if (!index.ok()) return index.error();
    return bytes_of(*index);
  }

  SourceCounters counters() const override { return {}; }

  Result<std::vector<TileEntry>> tile_index(const MapVersion& version, const std::string& segment,
                                            const std::string& layer) override {
    const std::lock_guard lock(file_->mutex);
    const Status checked = check(version);
    if (!checked.ok()) return checked.error();
    return file_->reader.tile_index(segment, layer);
  }

  Result<std::optional<Bytes>> stored_tile(const MapVersion& version, const std::string& segment,
                                           const std::string& layer,
                                           const TileEntry& entry) override {
    const std::lock_guard lock(file_->mutex);
    const Status checked = check(version);
    if (!checked.ok()) return checked.error();
    Result<Bytes> tile = file_->reader.tile(segment, layer, entry);
    if (!tile.ok()) return tile.error();
    return std::optional<Bytes>(std::move(tile).value());
  }

  Attempt fetch_tiles(const MapVersion& version, const std::string& segment,
                      const std::string& layer, const std::vector<TileEntry>& tiles,
                      const TileSink& take) override {
    for (const TileEntry& entry : tiles) {
      const auto tile = stored_tile(version, segment, layer, entry);
      if (!tile.ok()) return {tile.error()};
      take({entry.index, **tile});
    }
    return {};
  }

  std::shared_ptr<MapSource> until(Stopped stopped, Asking /*asking*/) override {
    return std::make_shared<FileSource>(file_, [first = stopped_, second = std::move(stopped)] {
      return is_stopped(first) || is_stopped(second);
    });
  }

 private:
  Status check(const MapVersion& version) const {
    if (version == file_->description.version) return ok_status();
    const std::string file = file_->reader.file().string();
    if (version.map != file_->description.version.map) {
      return Error{ErrorCode::not_found, file, "this is not the map \"" + version.map + "\"", ""};
    }
    return Error{ErrorCode::gone, file,
                 "the map was rebuilt: build " + version.build + " is gone, the current one is " +
                     file_->description.version.build,
                 "request the map's current build"};
  }

  // Loads the lines once; the file never changes under an open reader.
  Status load_lines() {
    if (file_->lines.has_value()) return ok_status();
    std::vector<KnownLine> lines;
    for (const std::string& id : file_->reader.segment_ids()) {
      const Result<StoredSegment> stored = file_->reader.segment(id);
      if (!stored.ok()) return stored.error();
      add_line(file_->description.version, description_of(*stored, file_->description.version.map),
               lines);
    }
    file_->lines = std::move(lines);
    return ok_status();
  }

  std::shared_ptr<OpenFile> file_;
  Stopped stopped_;
};

}  // namespace

Result<std::shared_ptr<MapSource>> open_file_source(const std::filesystem::path& map_file) {
  Result<MapReader> reader = MapReader::open(map_file);
  if (!reader.ok()) return reader.error();
  return std::shared_ptr<MapSource>(
      std::make_shared<FileSource>(std::make_shared<OpenFile>(std::move(reader).value())));
}

}  // namespace milepost
