#include "server/catalog/served_map.h"

#include <utility>
#include <vector>

#include "server/catalog/map_documents.h"

namespace milepost::server {
namespace {

Result<RouteLine> line_of(const StoredSegment& segment) {
  std::vector<GeoPoint> points;
  points.reserve(segment.vertices.size());
  for (const StoredVertex& vertex : segment.vertices) {
    points.push_back({vertex.latitude_deg, vertex.longitude_deg, vertex.altitude_m});
  }
  return RouteLine::from_vertices(std::move(points));
}

}  // namespace

Result<std::shared_ptr<const ServedMap>> ServedMap::open(const std::string& name,
                                                         std::shared_ptr<const HeldFile> file,
                                                         unsigned readers,
                                                         std::shared_ptr<MapFaults> faults) {
  Result<std::unique_ptr<ReaderPool>> pool = ReaderPool::open(file, readers);
  if (!pool) return pool.error();
  const std::shared_ptr<ServedMap> map(new ServedMap);
  map->name_ = name;
  map->file_ = std::move(file);
  map->readers_ = std::move(*pool);
  map->faults_ = std::move(faults);
  const Status loaded = map->load(*map->readers_->lend());
  if (!loaded) return loaded.error();
  return std::shared_ptr<const ServedMap>(map);
}

Status ServedMap::load(const MapReader& reader) {
  build_ = reader.build();
  layers_ = reader.layers();
  manifest_ = document_of(reader.manifest_document(), build_);
  summary_ = document_of(reader.map_document(), reader.manifest().map.digest);
  std::vector<SegmentLine> lines;
  for (const std::string& id : reader.segment_ids()) {
    Result<SegmentLine> line = load_segment(reader, id);
    if (!line) return line.error();
    lines.push_back(std::move(*line));
  }
  lines_ = std::make_shared<const MapLines>(std::move(lines));
  const Status cells_loaded = load_cells(reader);
  if (!cells_loaded) return cells_loaded;
  count_memory();
  return ok_status();
}

Result<SegmentLine> ServedMap::load_segment(const MapReader& reader, const std::string& id) {
  Result<StoredSegment> stored = reader.segment(id);
  if (!stored) return stored.error();
  Result<RouteLine> line = line_of(*stored);
  if (!line) {
    return Error{ErrorCode::corrupt, file_->path().string() + ", segment " + id, line.error().what,
                 "rebuild the map"};
  }
  std::map<std::string, std::vector<TileEntry>> tiles;
  for (const auto& [layer, parameters] : layers_) {
    Result<std::vector<TileEntry>> index = reader.tile_index(id, layer);
    if (!index) return index.error();
    tiles[layer] = std::move(*index);
  }
  Result<std::string> document = reader.segment_document(id);
  if (!document) return document.error();
  segments_.emplace(
      id, ServedSegment{std::move(tiles), document_of(std::move(*document),
                                                      reader.manifest().segments.at(id).digest)});
  return SegmentLine{id, stored->length_m, BoxedLine(std::move(*line))};
}

Status ServedMap::load_cells(const MapReader& reader) {
  for (const auto& [layer, parameters] : layers_) {
    Result<std::vector<CellEntry>> index = reader.cell_index(layer);
    if (!index) return index.error();
    cells_[layer] = std::move(*index);
  }
  Result<std::string> document = reader.areas_document();
  if (!document) return document.error();
  areas_ = document_of(std::move(*document), reader.manifest().areas.digest);
  return ok_status();
}

const Document& ServedMap::document() const {
  std::call_once(document_asked_for_, [this] {
    std::vector<std::string> ids;
    for (const auto& [id, segment] : segments_) ids.push_back(id);
    document_ = document_of(current_map_document(name_, build_, *summary_.text, ids));
  });
  return document_;
}

// The current document, which may be asked for later, has little more than the map's.
void ServedMap::count_memory() {
  memory_bytes_ = manifest_.text->size() + 2 * summary_.text->size() + 2 * areas_.text->size() +
                  lines_->memory_bytes();
  // The document, and the index that is written in it.
  for (const auto& [id, segment] : segments_) memory_bytes_ += 3 * segment.document.text->size();
}

Result<Bytes> ServedMap::tile(const std::string& segment, const std::string& layer,
                              const TileEntry& entry) const {
  return checked(
      readers_->lend()->tile(segment, layer, entry), entry.bytes,
      "segment " + segment + ", layer " + layer + ", tile " + std::to_string(entry.index));
}

Result<Bytes> ServedMap::cell(const std::string& layer, const CellEntry& entry) const {
  return checked(readers_->lend()->cell(layer, entry), entry.bytes,
                 "layer " + layer + ", cell " + std::to_string(entry.cell));
}

// The length was sent to the client before.
Result<Bytes> ServedMap::checked(Result<Bytes> tile, std::uint64_t bytes,
                                 const std::string& where) const {
  if (tile && tile->size() != bytes) {
    tile = Error{ErrorCode::corrupt, file_->path().string() + ", " + where,
                 "the length is not the one in the index",
                 "replace the file with a good copy, or rebuild the map"};
  }
  if (!tile) faults_->add(name_, build_, tile.error());
  return tile;
}

Result<std::string> ServedMap::mapping() const { return readers_->lend()->mapping_document(); }

}  // namespace milepost::server
