#include "client/fetch/server_requests.h"

#include <utility>

namespace milepost {
namespace {

constexpr std::uint64_t kMaxDocumentBytes = 64ULL << 20U;

}  // namespace

HttpAnswer ServerRequests::get(const std::string& url, std::uint64_t limit_bytes,
                               const BodySink& sink) {
  ++made_;
  HttpAnswer answer = transport_->get(url, limit_bytes, sink);
  bytes_received_ += answer.body_bytes;
  return answer;
}

Attempt ServerRequests::try_document(const std::string& url, std::string& text) {
  text.clear();
  HttpAnswer answer = get(url, kMaxDocumentBytes, [&](ByteView piece) {
    text += as_text(piece);
    return ok_status();
  });
  return {std::move(answer.status), answer.retry_after_s};
}

Result<std::string> ServerRequests::document(const std::string& url) {
  std::string text;
  const Status fetched = with_retries(retry_, [&] { return try_document(url, text); });
  if (!fetched.ok()) return fetched.error();
  return text;
}

}  // namespace milepost
