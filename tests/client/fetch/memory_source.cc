#include "tests/client/fetch/memory_source.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "client/fetch/nearby.h"
#include "schema/feature/types.h"

namespace milepost::testing {
namespace {

Error unavailable() { return {ErrorCode::unavailable, "map", "does not answer", "wait"}; }
Error gone() { return {ErrorCode::gone, "map", "was built anew", "look it up"}; }

}  // namespace

MemorySource::MemorySource(MapVersion version, std::string layer, nlohmann::json layer_parameters)
    : layer_(std::move(layer)),
      layer_parameters_(std::move(layer_parameters)),
      version_(std::move(version)) {}

void MemorySource::add(const SegmentDescription& segment, std::vector<Tile> tiles) {
  const std::lock_guard lock(mutex_);
  roads_[segment.id] = {segment, std::move(tiles)};
}

void MemorySource::build_anew(const std::string& build) {
  const std::lock_guard lock(mutex_);
  version_.build = build;
}

void MemorySource::refuse_tile(std::uint32_t index) {
  const std::lock_guard lock(mutex_);
  refused_.insert(index);
}

std::set<std::thread::id> MemorySource::callers() const {
  const std::lock_guard lock(mutex_);
  return callers_;
}

void MemorySource::note_caller() {
  const std::lock_guard lock(mutex_);
  callers_.insert(std::this_thread::get_id());
}

void MemorySource::wait_while_blocked() {
  while (is_blocked_) {
    {
      const std::lock_guard lock(mutex_);
      if (std::ranges::any_of(stopped_, is_stopped)) return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

Result<std::vector<NearbySegment>> MemorySource::segments_near(const GeoPoint& position,
                                                               double radius_m) {
  note_caller();
  ++near_requests_;
  wait_while_blocked();
  const std::lock_guard lock(mutex_);
  std::vector<KnownLine> lines;
  for (const auto& [id, road] : roads_) add_line(version_, road.description, lines);
  return lines_near(lines, position, radius_m);
}

Result<std::vector<MapVersion>> MemorySource::maps() {
  const std::lock_guard lock(mutex_);
  return std::vector<MapVersion>{version_};
}

Result<MapDescription> MemorySource::describe(const MapVersion& version) {
  note_caller();
  ++document_requests_;
  return MapDescription{version, {{layer_, layer_parameters_from_json(layer_parameters_)}}};
}

Result<SegmentDescription> MemorySource::segment(const MapVersion& /*version*/,
                                                 const std::string& segment) {
  note_caller();
  ++document_requests_;
  const std::lock_guard lock(mutex_);
  const auto found = roads_.find(segment);
  if (found == roads_.end()) return Error{ErrorCode::not_found, segment, "there is none", ""};
  return found->second.description;
}

Result<std::vector<EncodedTile>> MemorySource::tiles(const MapVersion& /*version*/,
                                                     const std::string& segment,
                                                     const std::string& /*layer*/,
                                                     const AlongRange& range) {
  const std::lock_guard lock(mutex_);
  std::vector<EncodedTile> met;
  const std::vector<Tile>& tiles = roads_.at(segment).tiles;
  for (std::uint32_t i = 0; i < tiles.size(); ++i) {
    if (tiles[i].along.meets(range)) met.push_back({i, tiles[i].bytes});
  }
  return met;
}

Result<std::vector<EncodedCell>> MemorySource::cells(const MapVersion& /*version*/,
                                                     const std::string& /*layer*/,
                                                     const Bounds& /*box*/) {
  return std::vector<EncodedCell>{};
}

Result<std::uint64_t> MemorySource::layer_bytes(const MapVersion& /*version*/,
                                                const std::string& segment,
                                                const std::string& /*layer*/) {
  const std::lock_guard lock(mutex_);
  std::uint64_t bytes = 0;
  for (const Tile& tile : roads_.at(segment).tiles) bytes += tile.bytes.size();
  return bytes;
}

Result<std::vector<TileEntry>> MemorySource::tile_index(const MapVersion& /*version*/,
                                                        const std::string& segment,
                                                        const std::string& /*layer*/) {
  note_caller();
  const std::lock_guard lock(mutex_);
  std::vector<TileEntry> index;
  for (const Tile& tile : roads_.at(segment).tiles) {
    TileEntry entry;
    entry.index = static_cast<std::uint32_t>(index.size());
    entry.along = tile.along;
    entry.bytes = tile.bytes.size();
    index.push_back(entry);
  }
  return index;
}

Result<std::optional<Bytes>> MemorySource::stored_tile(const MapVersion& /*version*/,
                                                       const std::string& segment,
                                                       const std::string& /*layer*/,
                                                       const TileEntry& entry) {
  note_caller();
  const std::lock_guard lock(mutex_);
  if (!is_stored_) return std::optional<Bytes>();
  return std::optional<Bytes>(roads_.at(segment).tiles[entry.index].bytes);
}

Attempt MemorySource::fetch_tiles(const MapVersion& version, const std::string& segment,
                                  const std::string& /*layer*/, const std::vector<TileEntry>& tiles,
                                  const TileSink& take) {
  note_caller();
  ++tile_requests_;
  wait_while_blocked();
  std::vector<EncodedTile> found;
  {
    const std::lock_guard lock(mutex_);
    if (is_unavailable_) return {unavailable()};
    if (version != version_) return {gone()};
    for (const TileEntry& entry : tiles) {
      if (refused_.contains(entry.index)) return {unavailable()};
      found.push_back({entry.index, roads_.at(segment).tiles[entry.index].bytes});
    }
  }
  for (const EncodedTile& tile : found) take(tile);
  return {};
}

std::shared_ptr<MapSource> MemorySource::until(Stopped stopped, Asking /*asking*/) {
  const std::lock_guard lock(mutex_);
  stopped_.push_back(std::move(stopped));
  return shared_from_this();
}

}  // namespace milepost::testing
