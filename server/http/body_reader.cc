#include "server/http/body_reader.h"

namespace milepost::server {
namespace {

std::size_t pieces_of(const Response& response) {
  if (const auto* list = std::get_if<TileList>(&response.body)) return list->tiles.size();
  return std::get<SharedText>(response.body) == nullptr ? 0 : 1;
}

}  // namespace

BodyReader::BodyReader(const Response& response, bool wanted)
    : response_(&response), pieces_(wanted ? pieces_of(response) : 0) {}

Result<ByteView> BodyReader::next() {
  if (done()) return ByteView();
  const std::size_t piece = given_++;
  if (const auto* text = std::get_if<SharedText>(&response_->body)) return as_bytes(**text);
  const auto& list = std::get<TileList>(response_->body);
  Result<Bytes> tile = list.map->tile(list.segment, list.layer, *list.tiles[piece]);
  if (!tile) return tile.error();
  tile_ = std::move(*tile);
  return ByteView(tile_);
}

}  // namespace milepost::server
