#include "server/http/outgoing.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace milepost::server {
namespace {

constexpr std::size_t kKeptPieces = 16;  // memory of a connection between responses

}  // namespace

void Outgoing::begin(PreparedAnswer answer, std::shared_ptr<const ServedMap> map,
                     std::string_view lines, std::string_view end, bool with_body) {
  answer_ = std::move(answer);
  map_ = std::move(map);
  end_ = lines;
  end_ += end;
  frames_ = with_body ? frame_count(answer_->response) : 0;
  next_frame_ = 0;
  add(answer_->head, nullptr);
  add(end_, nullptr);
  const auto* text = std::get_if<SharedText>(&answer_->response.body);
  if (with_body && text != nullptr && *text != nullptr) add(**text, nullptr);
}

void Outgoing::add(Frame frame) {
  ++next_frame_;
  std::string_view bytes = as_text(*frame);
  if (const auto& part = answer_->response.part) bytes = bytes.substr(part->first, part->bytes);
  add(bytes, std::move(frame));
}

void Outgoing::add(std::string_view bytes, Frame owner) {
  if (bytes.empty()) return;
  ready_bytes_ += bytes.size();
  pieces_.push_back({bytes, std::move(owner)});
}

std::size_t Outgoing::gather(std::span<iovec> buffers) const {
  const std::size_t count = std::min(buffers.size(), pieces_.size() - first_piece_);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string_view bytes = pieces_[first_piece_ + i].bytes;
    // Sending does not change them. NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
    buffers[i] = {const_cast<char*>(bytes.data()), bytes.size()};
  }
  return count;
}

void Outgoing::sent(std::size_t bytes) {
  ready_bytes_ -= bytes;
  while (bytes > 0) {
    Piece& piece = pieces_[first_piece_];
    const std::size_t part = std::min(bytes, piece.bytes.size());
    piece.bytes.remove_prefix(part);
    bytes -= part;
    if (!piece.bytes.empty()) break;
    piece.owner.reset();
    ++first_piece_;
  }
  if (first_piece_ < kKeptPieces && first_piece_ < pieces_.size()) return;
  pieces_.erase(pieces_.begin(), pieces_.begin() + static_cast<std::ptrdiff_t>(first_piece_));
  first_piece_ = 0;
}

void Outgoing::end() {
  answer_.reset();
  map_.reset();
  pieces_.clear();
  if (pieces_.capacity() > kKeptPieces) std::vector<Piece>().swap(pieces_);
  first_piece_ = 0;
  ready_bytes_ = 0;
  frames_ = 0;
  next_frame_ = 0;
}

}  // namespace milepost::server
