#include "server/http/body_reader.h"

namespace milepost::server {
namespace {

std::size_t pieces_of(const Response& response) {
  if (const auto* list = std::get_if<TileList>(&response.body)) return list->tiles.size();
  if (const auto* list = std::get_if<CellList>(&response.body)) return list->cells.size();
  return std::get<SharedText>(response.body) == nullptr ? 0 : 1;
}

// REQUIRES: a body of tiles or cells.
Result<Bytes> frame_of(const Response& response, std::size_t piece) {
  if (const auto* list = std::get_if<TileList>(&response.body)) {
    return list->map->tile(list->segment, list->layer, *list->tiles[piece]);
  }
  const auto& list = std::get<CellList>(response.body);
  return list.map->cell(list.layer, *list.cells[piece]);
}

}  // namespace

BodyReader::BodyReader(const Response& response, bool wanted)
    : response_(&response), pieces_(wanted ? pieces_of(response) : 0) {}

Result<ByteView> BodyReader::next() {
  if (done()) return ByteView();
  const std::size_t piece = given_++;
  if (const auto* text = std::get_if<SharedText>(&response_->body)) return as_bytes(**text);
  Result<Bytes> frame = frame_of(*response_, piece);
  if (!frame) return frame.error();
  frame_ = std::move(*frame);
  return ByteView(frame_);
}

}  // namespace milepost::server
