// Compressed parts of bags.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "schema/base/bytes.h"
#include "schema/base/result.h"

namespace milepost::ros {

// Memory that is not cleared: a part that states more than it holds costs what it holds.
class ExpandedBytes {
 public:
  ExpandedBytes() = default;
  explicit ExpandedBytes(std::size_t size)
      : bytes_(std::make_unique_for_overwrite<std::uint8_t[]>(size)), size_(size) {}

  std::uint8_t* data() { return bytes_.get(); }
  std::size_t size() const { return size_; }
  ByteView view() const { return {bytes_.get(), size_}; }

 private:
  std::unique_ptr<std::uint8_t[]> bytes_;
  std::size_t size_ = 0;
};

// The content of a chunk of ROS 1, `compression` as the chunk names it: none, bz2, lz4. Errors:
// corrupt (other content, or of another size than stated), invalid_input (another compression, a
// size above 1 GiB); `where` is left to the caller.
Result<ExpandedBytes> expanded_chunk(ByteView chunk, std::string_view compression,
                                     std::uint64_t stated_size);

// Whether a message of ROS 2 is compressed on its own, by zstd; CDR never begins so.
bool is_zstd(ByteView message);
// Its content. Errors: as above.
Result<ExpandedBytes> expanded_zstd(ByteView message);

}  // namespace milepost::ros
