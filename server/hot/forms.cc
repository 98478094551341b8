#include "server/hot/forms.h"

#include <string>
#include <utility>

namespace milepost::server {
namespace {

constexpr std::size_t kWorthCoding = 512;  // bytes; a smaller document fits a packet anyway
constexpr std::string_view kPublic = "public, ";

std::string* header_of(Response& response, std::string_view name) {
  for (auto& header : response.headers) {
    if (header.first == name) return &header.second;
  }
  return nullptr;
}

// "\"digest\"" becomes "\"digest-gzip\"".
std::string tag_in_coding(std::string tag, ContentCoding coding) {
  return tag.insert(tag.size() - 1, '-' + std::string(name_of(coding)));
}

Response with_content_range(Response response, const std::string& range, std::uint64_t size) {
  response.headers.emplace_back("Content-Range", "bytes " + range + '/' + std::to_string(size));
  return response;
}

}  // namespace

bool has_codings(const Response& response) {
  const auto* text = std::get_if<SharedText>(&response.body);
  return response.status == 200 && text != nullptr && *text != nullptr &&
         (*text)->size() >= kWorthCoding && !response.header("ETag").empty();
}

Result<PreparedAnswer> in_coding(const PreparedAnswer& answer, ContentCoding coding) {
  Response response = answer->response;
  Result<std::string> bytes = coded(*std::get<SharedText>(response.body), coding);
  if (!bytes) return bytes.error();
  response.body = shared_text(std::move(*bytes));
  std::string& tag = *header_of(response, "ETag");
  tag = tag_in_coding(std::move(tag), coding);
  response.headers.emplace_back("Content-Encoding", name_of(coding));
  return prepared(std::move(response));
}

PreparedAnswer part_for(const PreparedAnswer& answer, const Request& request) {
  const Response& whole = answer->response;
  if (request.range.empty() || request.method != "GET" || whole.status != 200 ||
      whole.header("Accept-Ranges").empty() ||
      !allows_part(request.if_range, whole.header("ETag"))) {
    return answer;
  }
  const std::uint64_t size = whole.content_length();
  const RangeRequest range = parse_range(request.range, size);
  if (range.kind == RangeRequest::Kind::whole) return answer;
  if (range.kind == RangeRequest::Kind::beyond) {
    Response refused = problem(
        416, "the range begins beyond the tile's " + std::to_string(size) + " bytes; ask for less");
    refused.route = whole.route;
    refused.map = whole.map;
    return prepared(with_content_range(std::move(refused), "*", size));
  }
  const std::uint64_t last = range.part.first + range.part.bytes - 1;
  Response part = with_content_range(
      whole, std::to_string(range.part.first) + '-' + std::to_string(last), size);
  part.status = 206;
  part.part = range.part;
  return prepared_for(std::move(part), answer->map);
}

Response for_one_client(Response response) {
  std::string* cache_control = header_of(response, "Cache-Control");
  if (cache_control == nullptr || *cache_control == "no-store") return response;
  if (cache_control->starts_with(kPublic)) cache_control->erase(0, kPublic.size());
  cache_control->insert(0, "private, ");
  return response;
}

}  // namespace milepost::server
