// Fields of a request that change its answer:
// "RANGE\nIF-RANGE\nIF-NONE-MATCH\nACCEPT-ENCODING\nORIGIN\nBODY".
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "server/hot/forms.h"
#include "server/message/conditional.h"
#include "server/message/cross_origin.h"
#include "tests/fuzz/check.h"

using namespace milepost;
using namespace milepost::server;

namespace {

std::string next_field(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string field(text.substr(0, end));
  text.remove_prefix(std::min(end + 1, text.size()));
  return field;
}

Response answer_with(const std::string& body) {
  Response response;
  response.headers = {{"Cache-Control", "public, max-age=31536000, immutable"},
                      {"ETag", entity_tag(std::string(32, 'a'))},
                      {"Accept-Ranges", "bytes"}};
  response.body = shared_text(body);
  return response;
}

void check_head(const std::string& head) {
  fuzz::check(head.ends_with("\r\n") && head.find("\r\n\r\n") == std::string::npos);
}

void check_part(const PreparedAnswer& answer, const Request& request, std::uint64_t size) {
  const PreparedAnswer part = part_for(answer, request);
  check_head(part->head);
  const Response& response = part->response;
  fuzz::check(response.status == 200 || response.status == 206 || response.status == 416);
  fuzz::check((response.status == 206) == response.part.has_value());
  if (!response.part) return;
  fuzz::check(response.part->bytes > 0 && response.part->bytes <= size);
  fuzz::check(response.part->first <= size - response.part->bytes);
  fuzz::check(response.content_length() == response.part->bytes);
}

void check_condition(const PreparedAnswer& answer, const std::string& if_none_match) {
  const PreparedAnswer chosen = unless_known(answer, if_none_match);
  const bool is_known = chosen->response.status == 304;
  fuzz::check(is_known || chosen == answer);
  // A tag is known only where it is written, or by the star.
  const bool has_tag = if_none_match.find(entity_tag(std::string(32, 'a'))) != std::string::npos;
  fuzz::check(!is_known || has_tag || if_none_match.find('*') != std::string::npos);
  check_head(chosen->head);
}

void check_coding(const PreparedAnswer& answer, const std::string& accept_encoding) {
  const ContentCoding coding = preferred_coding(accept_encoding);
  if (coding == ContentCoding::identity || !has_codings(answer->response)) return;
  const auto coded = in_coding(answer, coding);
  fuzz::check(coded.ok());
  check_head((*coded)->head);
  fuzz::check((*coded)->response.header("Content-Encoding") == name_of(coding));
}

void check_origin(const std::string& origin, const std::string& method) {
  const std::string lines = cross_origin_lines({"https://a.example.org"}, origin, method);
  check_head(lines);
  const bool is_allowed = lines.find("Access-Control-Allow-Origin") != std::string::npos;
  fuzz::check(is_allowed == (origin == "https://a.example.org"));
  // What an operator may set ends no line of a head.
  if (is_origin(origin)) check_head(cross_origin_lines({origin}, origin, method));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  Request request;
  request.method = size % 2 == 0 ? "GET" : "OPTIONS";
  request.range = next_field(text);
  request.if_range = next_field(text);
  request.if_none_match = next_field(text);
  request.accept_encoding = next_field(text);
  request.origin = next_field(text);
  const std::string body(text);
  const PreparedAnswer answer = prepared(answer_with(body));
  check_part(answer, request, body.size());
  check_condition(answer, request.if_none_match);
  check_coding(answer, request.accept_encoding);
  check_origin(request.origin, request.method);
  return 0;
}
