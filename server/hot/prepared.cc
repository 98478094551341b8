#include "server/hot/prepared.h"

#include <utility>

#include "server/message/conditional.h"
#include "server/message/head.h"

namespace milepost::server {

std::size_t Prepared::bytes() const {
  std::size_t bytes = sizeof(Prepared) + head.size();
  if (unchanged) bytes += unchanged->bytes();
  if (const auto* text = std::get_if<SharedText>(&response.body)) {
    return bytes + (*text ? (*text)->size() : 0);
  }
  if (const auto* list = std::get_if<TileList>(&response.body)) {
    return bytes + list->tiles.size() * sizeof(void*);
  }
  const auto& cells = std::get<CellList>(response.body).cells;
  return bytes + cells.size() * sizeof(void*);
}

PreparedAnswer prepared(Response response) {
  std::weak_ptr<const ServedMap> map = map_of(response);
  if (auto* tiles = std::get_if<TileList>(&response.body)) tiles->map = nullptr;
  if (auto* cells = std::get_if<CellList>(&response.body)) cells->map = nullptr;
  return prepared_for(std::move(response), std::move(map));
}

PreparedAnswer prepared_for(Response response, std::weak_ptr<const ServedMap> map) {
  auto answer = std::make_shared<Prepared>();
  answer->head = head_of(response);
  if (response.status == 200 && !response.header("ETag").empty()) {
    answer->unchanged = prepared(unless_known(response, response.header("ETag")));
  }
  answer->response = std::move(response);
  answer->map = std::move(map);
  return answer;
}

std::shared_ptr<const ServedMap> map_of(const Response& response) {
  if (const auto* tiles = std::get_if<TileList>(&response.body)) return tiles->map;
  if (const auto* cells = std::get_if<CellList>(&response.body)) return cells->map;
  return nullptr;
}

const PreparedAnswer& unless_known(const PreparedAnswer& answer, std::string_view if_none_match) {
  if (if_none_match.empty() || !answer->unchanged) return answer;
  return names_tag(if_none_match, answer->response.header("ETag")) ? answer->unchanged : answer;
}

}  // namespace milepost::server
