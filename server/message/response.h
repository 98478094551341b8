// A response to a client, independent of sockets.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "schema/base/result.h"
#include "server/catalog/served_map.h"
#include "server/message/byte_range.h"

namespace milepost::server {

using SharedText = std::shared_ptr<const std::string>;

// Stored tiles of one layer of one segment, to be sent one after the other as stored in the map.
// Keeps the map alive; the tiles' bytes are read only while they are sent.
struct TileList {
  std::shared_ptr<const ServedMap> map;
  std::string segment;
  std::string layer;
  std::vector<const TileEntry*> tiles;  // entries of `map`, ascending by index
};

// The same for stored cells of one layer.
struct CellList {
  std::shared_ptr<const ServedMap> map;
  std::string layer;
  std::vector<const CellEntry*> cells;  // entries of `map`, ascending by cell
};

// Who may have a response, where tokens are asked for.
enum class Guard {
  open,       // everybody
  map,        // whose token is for the map
  catalog,    // whose token is valid, with what it is for
  operators,  // whose token is for everything
};

struct Response {
  unsigned status = 200;
  std::vector<std::pair<std::string, std::string>> headers;  // without Content-Length
  std::variant<SharedText, TileList, CellList> body;         // a null text is an empty body
  std::string_view route;  // the pattern of handle.h that fitted; constant text. Empty: none
  std::string map;         // that the path names, if it fitted
  Guard guard = Guard::open;
  std::optional<ByteRange> part = {};  // of a body of tiles or cells that is sent; none: all of it

  // The value of a header, empty if absent. `name` is spelled as when it was added.
  std::string_view header(std::string_view name) const;
  // Bytes of the body, known before any tile is read.
  std::uint64_t content_length() const;
};

SharedText shared_text(std::string text);

// An application/problem+json response: `status`, and what is wrong and how to correct it.
Response problem(unsigned status, const std::string& detail);
// The same for an Error: 400, 404, 410, 503 or 500 by its code.
Response problem(const Error& error);
// The detail of such a response.
std::string problem_detail(const Response& response);

}  // namespace milepost::server
