#include "client/fetch/server_requests.h"

#include <utility>

namespace milepost {
namespace {

constexpr std::uint64_t kMaxDocumentBytes = 64ULL << 20U;

}  // namespace

HttpAnswer ServerRequests::get(const std::string& url, std::uint64_t limit_bytes,
                               const BodySink& sink, const Stopped& stopped) {
  ++made_;
  HttpAnswer answer = transport_->get(url, limit_bytes, sink, stopped);
  bytes_received_ += answer.body_bytes;
  return answer;
}

Attempt ServerRequests::try_document(const std::string& url, const DocumentReader& read,
                                     const Stopped& stopped) {
  std::string text;
  const HttpAnswer answer = get(
      url, kMaxDocumentBytes,
      [&](ByteView piece) {
        text += as_text(piece);
        return ok_status();
      },
      stopped);
  Status done = answer.status.ok() ? read(text) : answer.status;
  if (!done.ok() && done.error().code == ErrorCode::corrupt) {
    done = foreign_answer(url, done.error().what);
  }
  return {std::move(done), answer.retry_after_s};
}

}  // namespace milepost
