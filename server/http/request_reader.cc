#include "server/http/request_reader.h"

#include <utility>

#include "server/http/plain_request.h"

namespace milepost::server {

void RequestReader::add(std::string_view bytes) {
  if (bytes_.empty()) {
    bytes_ = bytes;
    is_kept_ = false;
  } else {
    keep();
    kept_ += bytes;
    bytes_ = kept_;
  }
}

bool RequestReader::next(Incoming& incoming) {
  if (bytes_.empty()) return false;
  if (parser_ == nullptr) {
    const std::size_t taken = take_plain_request(bytes_, limits_, incoming);
    bytes_.remove_prefix(taken);
    if (taken > 0) return true;
    parser_ = std::make_unique<RequestParser>(limits_);
    continued_ = false;
  }
  bytes_.remove_prefix(parser_->take(bytes_));
  if (!parser_->done()) {
    if (parser_->untouched() && bytes_.empty()) parser_.reset();  // nothing but empty lines
    return false;
  }
  incoming = std::move(parser_->incoming());
  parser_.reset();
  return true;
}

void RequestReader::keep() {
  if (bytes_.empty()) {
    std::string().swap(kept_);
  } else if (is_kept_) {
    kept_.erase(0, static_cast<std::size_t>(bytes_.data() - kept_.data()));
  } else {
    kept_ = bytes_;
  }
  bytes_ = kept_;
  is_kept_ = true;
}

bool RequestReader::wants_continue() {
  if (continued_ || parser_ == nullptr || !parser_->wants_continue()) return false;
  continued_ = true;
  return true;
}

}  // namespace milepost::server
