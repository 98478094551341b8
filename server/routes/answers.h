// Successful responses with their caching rules.
#pragma once

#include <string>
#include <vector>

#include "schema/base/digest.h"
#include "server/catalog/document.h"
#include "server/message/response.h"

namespace milepost::server {

// Plain text that is not cached.
Response plain_text(std::string text);
// Text that may change at any time: a cache must revalidate its copy each time.
Response current_text(const Document& document, const char* content_type);
Response current_json(const Document& document);
// Text and JSON that never change under their URL.
Response immutable_text(const Document& document, const char* content_type);
Response immutable_json(const Document& document);
// Stored tiles or cells, which never change under their URL. `digest` covers all of them.
Response immutable_tiles(TileList tiles, const std::string& digest);
Response immutable_cells(CellList cells, const std::string& digest);
// The same response, of which parts may be asked for, too.
Response divisible(Response response);

// The digest that covers entries of an index: that of their digests, one after the other.
template <class Entry>
std::string digest_of_all(const std::vector<const Entry*>& entries) {
  std::string digests;
  for (const Entry* entry : entries) digests += entry->digest;
  return digest_of(as_bytes(digests));
}

}  // namespace milepost::server
