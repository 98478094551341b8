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

SegmentDescription description_of(const StoredSegment& stored) {
  SegmentDescription description{stored.id, stored.length_m, {}, stored.successors};
  for (const StoredVertex& vertex : stored.vertices) {
    description.vertices.push_back({vertex.latitude_deg, vertex.longitude_deg, vertex.altitude_m});
  }
  return description;
}

// Of a JSON object that lies in the map as text.
template <class Parameters>
Result<Parameters> parameters_from(const std::string& text,
                                   Result<Parameters> (*from_json)(const nlohmann::json&)) {
  const Result<nlohmann::json> json = read_json(text);
  if (json) return from_json(*json);
  Error error = json.error();
  error.mend = "build the map anew";
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
  return description;
}

class FileSource : public MapSource, public std::enable_shared_from_this<FileSource> {
 public:
  explicit FileSource(MapReader reader)
      : reader_(std::move(reader)), description_(description_of(reader_)) {}

  Result<std::vector<NearbySegment>> segments_near(const GeoPoint& position,
                                                   double radius_m) override {
    const std::lock_guard lock(mutex_);
    Status ready = check_near_query(position, radius_m);
    if (ready.ok()) ready = load_lines();
    if (!ready.ok()) return ready.error();
    return lines_near(*lines_, position, radius_m);
  }

  Result<std::vector<MapVersion>> maps() override {
    return std::vector<MapVersion>{description_.version};
  }

  Result<MapDescription> describe(const MapVersion& version) override {
    const std::lock_guard lock(mutex_);
    const Status checked = check(version);
    if (!checked.ok()) return checked.error();
    return description_;
  }

  Result<SegmentDescription> segment(const MapVersion& version,
                                     const std::string& segment) override {
    const std::lock_guard lock(mutex_);
    const Status checked = check(version);
    if (!checked.ok()) return checked.error();
    const Result<StoredSegment> stored = reader_.segment(segment);
    if (!stored.ok()) return stored.error();
    return description_of(*stored);
  }

  Result<std::vector<EncodedTile>> tiles(const MapVersion& version, const std::string& segment,
                                         const std::string& layer,
                                         const AlongRange& range) override {
    const std::lock_guard lock(mutex_);
    const Status checked = check(version);
    if (!checked.ok()) return checked.error();
    const auto entries = reader_.tiles_in(segment, layer, range);
    if (!entries.ok()) return entries.error();
    std::vector<EncodedTile> tiles;
    for (const TileEntry& entry : *entries) {
      Result<Bytes> tile = reader_.tile(segment, layer, entry.index);
      if (!tile.ok()) return tile.error();
      tiles.push_back({entry.index, std::move(tile).value()});
    }
    return tiles;
  }

  Result<std::vector<EncodedCell>> cells(const MapVersion& version, const std::string& layer,
                                         const Bounds& box) override {
    const std::lock_guard lock(mutex_);
    Status checked = check_area_query(box);
    if (checked.ok()) checked = check(version);
    if (!checked.ok()) return checked.error();
    const auto entries = reader_.cells_in(layer, box);
    if (!entries.ok()) return entries.error();
    std::vector<EncodedCell> tiles;
    for (const CellEntry& entry : *entries) {
      Result<Bytes> tile = reader_.cell(layer, entry.cell);
      if (!tile.ok()) return tile.error();
      tiles.push_back({entry.cell, std::move(tile).value()});
    }
    return tiles;
  }

  Result<std::uint64_t> layer_bytes(const MapVersion& version, const std::string& segment,
                                    const std::string& layer) override {
    const std::lock_guard lock(mutex_);
    const Status checked = check(version);
    if (!checked.ok()) return checked.error();
    const auto index = reader_.tile_index(segment, layer);
    if (!index.ok()) return index.error();
    return bytes_of(*index);
  }

  SourceCounters counters() const override { return {}; }

  Result<std::vector<TileEntry>> tile_index(const MapVersion& version, const std::string& segment,
                                            const std::string& layer) override {
    const std::lock_guard lock(mutex_);
    const Status checked = check(version);
    if (!checked.ok()) return checked.error();
    return reader_.tile_index(segment, layer);
  }

  Result<std::optional<Bytes>> stored_tile(const MapVersion& version, const std::string& segment,
                                           const std::string& layer,
                                           const TileEntry& entry) override {
    const std::lock_guard lock(mutex_);
    const Status checked = check(version);
    if (!checked.ok()) return checked.error();
    Result<Bytes> tile = reader_.tile(segment, layer, entry.index);
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

  // No call takes long.
  std::shared_ptr<MapSource> until(Stopped /*stopped*/, Asking /*asking*/) override {
    return shared_from_this();
  }

 private:
  Status check(const MapVersion& version) const {
    if (version == description_.version) return ok_status();
    const std::string file = reader_.file().string();
    if (version.map != description_.version.map) {
      return Error{ErrorCode::not_found, file, "this is not the map \"" + version.map + "\"", ""};
    }
    return Error{ErrorCode::gone, file,
                 "the map was rebuilt: build " + version.build + " is gone, the current one is " +
                     description_.version.build,
                 "ask for the map's current build"};
  }

  // Once; the file never changes under an open reader.
  Status load_lines() {
    if (lines_.has_value()) return ok_status();
    std::vector<KnownLine> lines;
    for (const std::string& id : reader_.segment_ids()) {
      const Result<StoredSegment> stored = reader_.segment(id);
      if (!stored.ok()) return stored.error();
      add_line(description_.version, description_of(*stored), lines);
    }
    lines_ = std::move(lines);
    return ok_status();
  }

  std::mutex mutex_;  // guards the reader and what is read
  MapReader reader_;
  const MapDescription description_;
  std::optional<std::vector<KnownLine>> lines_;
};

}  // namespace

Result<std::shared_ptr<MapSource>> open_file_source(const std::filesystem::path& map_file) {
  Result<MapReader> reader = MapReader::open(map_file);
  if (!reader.ok()) return reader.error();
  return std::shared_ptr<MapSource>(std::make_shared<FileSource>(std::move(reader).value()));
}

}  // namespace milepost
