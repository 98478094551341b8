// A response with its head as bytes, to be sent any number of times.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "server/message/response.h"

namespace milepost::server {

struct Prepared;
using PreparedAnswer = std::shared_ptr<const Prepared>;

struct Prepared {
  Response response;  // without the map of its tiles, which it does not keep in memory
  std::weak_ptr<const ServedMap> map;  // of its tiles; expired for a response without
  std::string head;                    // without what HeadEnds adds for each connection
  PreparedAnswer unchanged;            // the 304 in its place; null if it has no tag

  std::size_t bytes() const;  // of memory, without tiles and cells
};

PreparedAnswer prepared(Response response);
// A response whose tiles are of this map, which it does not keep in memory.
PreparedAnswer prepared_for(Response response, std::weak_ptr<const ServedMap> map);

// The map of a response's tiles; null without.
std::shared_ptr<const ServedMap> map_of(const Response& response);

// The answer itself, or 304 if the client's If-None-Match, empty if absent, names its tag.
const PreparedAnswer& unless_known(const PreparedAnswer& answer, std::string_view if_none_match);

}  // namespace milepost::server
