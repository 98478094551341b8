// The response that a connection is sending.
#pragma once

#include <sys/uio.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/hot/frames_of.h"
#include "server/hot/prepared.h"

namespace milepost::server {

// Not safe to use from several threads at once.
class Outgoing {
 public:
  // `map`: of the body's frames; null without. `lines` and then `end` (HeadEnds) complete the head,
  // and are copied. REQUIRES: complete().
  void begin(PreparedAnswer answer, std::shared_ptr<const ServedMap> map, std::string_view lines,
             std::string_view end, bool with_body);
  bool begun() const { return answer_ != nullptr; }
  // REQUIRES: begun(), until end().
  const PreparedAnswer& answer() const { return answer_; }
  const Response& response() const { return answer_->response; }
  const std::shared_ptr<const ServedMap>& map() const { return map_; }

  // The next frame of the body has not been added, and there is room for it.
  bool wants_frame() const { return next_frame_ < frames_ && ready_bytes_ < kReadAheadBytes; }
  // Index of the next frame of the body.
  std::size_t next_frame() const { return next_frame_; }
  void add(Frame frame);

  // Bytes that can be sent now.
  std::size_t ready_bytes() const { return ready_bytes_; }
  // Sets buffers to the next of these bytes, and returns how many it set.
  std::size_t gather(std::span<iovec> buffers) const;
  // The first `bytes` of them are sent.
  void sent(std::size_t bytes);
  bool complete() const { return ready_bytes_ == 0 && next_frame_ == frames_; }
  // Releases what it refers to.
  void end();

 private:
  struct Piece {
    std::string_view bytes;  // not sent yet
    Frame owner;             // null for head and text
  };
  void add(std::string_view bytes, Frame owner);

  PreparedAnswer answer_;
  std::shared_ptr<const ServedMap> map_;
  std::string end_;
  std::size_t frames_ = 0;      // of the body
  std::size_t next_frame_ = 0;  // to be added
  std::vector<Piece> pieces_;
  std::size_t first_piece_ = 0;  // not sent completely
  std::size_t ready_bytes_ = 0;
};

}  // namespace milepost::server
