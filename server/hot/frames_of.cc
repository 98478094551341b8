#include "server/hot/frames_of.h"

#include <utility>

namespace milepost::server {
namespace {

// From the disk. REQUIRES: a body of tiles or cells.
Result<Bytes> stored_frame(const Response& response, const ServedMap& map, std::size_t index) {
  if (const auto* list = std::get_if<TileList>(&response.body)) {
    return map.tile(list->segment, list->layer, *list->tiles[index]);
  }
  const auto& list = std::get<CellList>(response.body);
  return map.cell(list.layer, *list.cells[index]);
}

Result<Frame> hot_or_stored_frame(const Response& response, const ServedMap& map, std::size_t index,
                                  HotFrames& memory) {
  const std::string_view digest = frame_digest(response, index);
  if (Frame hot = memory.find(digest)) return hot;
  Result<Bytes> stored = stored_frame(response, map, index);
  if (!stored) return stored.error();
  return memory.add(digest, std::make_shared<const Bytes>(std::move(stored).value()));
}

}  // namespace

std::size_t frame_count(const Response& response) {
  if (const auto* list = std::get_if<TileList>(&response.body)) return list->tiles.size();
  if (const auto* list = std::get_if<CellList>(&response.body)) return list->cells.size();
  return 0;
}

std::string_view frame_digest(const Response& response, std::size_t index) {
  if (const auto* list = std::get_if<TileList>(&response.body)) return list->tiles[index]->digest;
  return std::get<CellList>(response.body).cells[index]->digest;
}

Result<std::vector<Frame>> read_frames(const Response& response, const ServedMap& map,
                                       std::size_t first, HotFrames& memory) {
  std::vector<Frame> frames;
  std::size_t bytes = 0;
  for (std::size_t i = first; i < frame_count(response) && bytes < kReadAheadBytes; ++i) {
    Result<Frame> frame = hot_or_stored_frame(response, map, i, memory);
    if (!frame && frames.empty()) return frame.error();
    if (!frame) break;
    bytes += (*frame)->size();
    frames.push_back(std::move(frame).value());
  }
  return frames;
}

}  // namespace milepost::server
