#include "server/routes/answers.h"

#include "server/message/conditional.h"

namespace milepost::server {
namespace {

constexpr const char* kJson = "application/json";
constexpr const char* kImmutable = "public, max-age=31536000, immutable";

Response text(const Document& document, const char* content_type, const char* cache_control) {
  Response response;
  response.headers = {{"Content-Type", content_type},
                      {"Cache-Control", cache_control},
                      {"ETag", entity_tag(document.digest)}};
  response.body = document.text;
  return response;
}

template <class List>
Response frames(List list, const std::string& digest) {
  Response response;
  response.headers = {{"Content-Type", "application/octet-stream"},
                      {"Cache-Control", kImmutable},
                      {"ETag", entity_tag(digest)}};
  response.body = std::move(list);
  return response;
}

}  // namespace

Response plain_text(std::string text) {
  Response response;
  response.headers = {{"Content-Type", "text/plain; charset=utf-8"}, {"Cache-Control", "no-store"}};
  response.body = shared_text(std::move(text));
  return response;
}

Response current_text(const Document& document, const char* content_type) {
  return text(document, content_type, "no-cache");
}

Response current_json(const Document& document) { return current_text(document, kJson); }

Response immutable_text(const Document& document, const char* content_type) {
  return text(document, content_type, kImmutable);
}

Response immutable_json(const Document& document) { return immutable_text(document, kJson); }

Response immutable_tiles(TileList tiles, const std::string& digest) {
  return frames(std::move(tiles), digest);
}

Response immutable_cells(CellList cells, const std::string& digest) {
  return frames(std::move(cells), digest);
}

Response divisible(Response response) {
  response.headers.emplace_back("Accept-Ranges", "bytes");
  return response;
}

}  // namespace milepost::server
