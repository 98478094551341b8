// Requests to a server, counted and retried where that may help.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "client/fetch/retry.h"
#include "client/fetch/transport.h"

namespace milepost {

// Parses a document. The error code corrupt means that it does not come from a milepost server.
using DocumentReader = std::function<Status(const std::string& text)>;

// Safe to use from several threads at once.
class ServerRequests {
 public:
  ServerRequests(std::unique_ptr<Transport> transport, RetryPolicy retry)
      : transport_(std::move(transport)), retry_(std::move(retry)) {}

  // One request, as Transport::get.
  HttpAnswer get(const std::string& url, std::uint64_t limit_bytes, Caches caches,
                 const BodySink& sink, const Stopped& stopped);
  // One request for a document of at most 64 MiB. Errors: those of HttpAnswer and of the reader,
  // with corrupt replaced by foreign_answer.
  Attempt try_document(const std::string& url, const DocumentReader& read, const Stopped& stopped);
  // One request for a document that a build covers, and if `is_it` denies the text another one past
  // caches. `resembles_it`, success or why not, tells a damaged document from something else.
  // Errors: those of HttpAnswer; corrupt (damaged); foreign_answer.
  struct CoveredDocument {
    std::string url;
    std::uint64_t limit_bytes = 0;
    std::function<bool(const std::string& text)> is_it;
    DocumentReader resembles_it;
  };
  struct DocumentAttempt {
    Attempt attempt;
    std::string text;  // of the document, if it succeeded
  };
  DocumentAttempt try_covered_document(const CoveredDocument& document, const Stopped& stopped);

  const RetryPolicy& retry() const { return retry_; }
  std::uint64_t made() const { return made_; }
  std::uint64_t bytes_received() const { return bytes_received_; }

 private:
  HttpAnswer get_text(const std::string& url, std::uint64_t limit_bytes, Caches caches,
                      std::string& text, const Stopped& stopped);

  const std::unique_ptr<Transport> transport_;
  const RetryPolicy retry_;
  std::atomic<std::uint64_t> made_ = 0;
  std::atomic<std::uint64_t> bytes_received_ = 0;
};

}  // namespace milepost
