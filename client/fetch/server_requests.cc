#include "client/fetch/server_requests.h"

#include <utility>

#include "schema/document/manifest.h"

namespace milepost {

HttpAnswer ServerRequests::get(const std::string& url, std::uint64_t limit_bytes, Caches caches,
                               const BodySink& sink, const Stopped& stopped) {
  ++made_;
  HttpAnswer answer = transport_->get(url, limit_bytes, caches, sink, stopped);
  bytes_received_ += answer.body_bytes;
  return answer;
}

HttpAnswer ServerRequests::get_text(const std::string& url, std::uint64_t limit_bytes,
                                    Caches caches, std::string& text, const Stopped& stopped) {
  text.clear();
  const auto append = [&text](ByteView piece) {
    text += as_text(piece);
    return ok_status();
  };
  return get(url, limit_bytes, caches, append, stopped);
}

Attempt ServerRequests::try_document(const std::string& url, const DocumentReader& read,
                                     const Stopped& stopped) {
  std::string text;
  const HttpAnswer answer = get_text(url, kMaxDocumentBytes, Caches::allowed, text, stopped);
  Status done = answer.status.ok() ? read(text) : answer.status;
  const bool is_other = !done.ok() && done.error().code == ErrorCode::corrupt;
  if (is_other) done = foreign_answer(url, done.error().what);
  return {std::move(done), answer.retry_after_s, answer.is_foreign || is_other};
}

ServerRequests::DocumentAttempt ServerRequests::try_covered_document(
    const CoveredDocument& document, const Stopped& stopped) {
  std::string text;
  Status wrong;
  for (const Caches caches : {Caches::allowed, Caches::bypassed}) {
    const HttpAnswer answer = get_text(document.url, document.limit_bytes, caches, text, stopped);
    if (answer.status.ok() && document.is_it(text)) return {{}, std::move(text)};
    const bool is_too_long =
        !answer.status.ok() && answer.status.error().code == ErrorCode::corrupt;
    if (!answer.status.ok() && !is_too_long) return {{answer.status, answer.retry_after_s}, {}};
    wrong = is_too_long ? answer.status : document.resembles_it(text);
  }
  if (!wrong.ok()) return {{foreign_answer(document.url, wrong.error().what)}, {}};
  return {{Error{ErrorCode::corrupt, document.url,
                 "the document is damaged: it does not have the digest that its build gives",
                 "verify the server's map and check proxies between the client and the server"}},
          {}};
}

}  // namespace milepost
