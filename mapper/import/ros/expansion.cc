#include "mapper/import/ros/expansion.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <new>
#include <string>

namespace milepost::ros {
namespace {

constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 30U;

Error damaged() { return {ErrorCode::corrupt, "", "cannot be decompressed", "copy the bag again"}; }

Error too_large() {
  return {ErrorCode::invalid_input, "", "states more than 1 GiB of content",
          "record the bag with smaller chunks"};
}

// Each fills all of `content`, which is what the compressed bytes hold, or returns false.

bool expand_bz2(ByteView compressed, ExpandedBytes& content) {
  // The library's interface is not const, but does not write to its source.
  auto* const source = const_cast<char*>(  // NOLINT(cppcoreguidelines-pro-type-const-cast)
      as_text(compressed).data());
  auto size = static_cast<unsigned>(content.size());
  const int code =
      BZ2_bzBuffToBuffDecompress(reinterpret_cast<char*>(content.data()), &size, source,
                                 static_cast<unsigned>(compressed.size()), 0, 0);
  return code == BZ_OK && size == content.size();
}

struct FreeContext {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

bool expand_lz4(ByteView compressed, ExpandedBytes& content) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0)
    throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, FreeContext> context(raw);
  std::size_t written = 0;
  std::size_t read = 0;
  for (;;) {
    std::size_t room = content.size() - written;
    std::size_t left = compressed.size() - read;
    const std::size_t wanted = LZ4F_decompress(context.get(), content.data() + written, &room,
                                               compressed.data() + read, &left, nullptr);
    if (LZ4F_isError(wanted) != 0) return false;
    written += room;
    read += left;
    if (wanted == 0) return written == content.size();
    if (room == 0 && left == 0) return false;  // it ends too early, or holds too much
  }
}

}  // namespace

Result<ExpandedBytes> expanded_chunk(ByteView chunk, std::string_view compression,
                                     std::uint64_t stated_size) {
  if (stated_size > kMaxBytes || chunk.size() > kMaxBytes) return too_large();
  ExpandedBytes content(stated_size);
  if (compression == "none") {
    if (chunk.size() != content.size()) return damaged();
    std::ranges::copy(chunk, content.data());
    return content;
  }
  if (compression == "bz2")
    return expand_bz2(chunk, content) ? Result(std::move(content)) : damaged();
  if (compression == "lz4")
    return expand_lz4(chunk, content) ? Result(std::move(content)) : damaged();
  return Error{ErrorCode::invalid_input, "",
               "is compressed as '" + std::string(compression.substr(0, 40)) + "'",
               "record or rewrite the bag with lz4, bz2 or without compression"};
}

bool is_zstd(ByteView message) {
  constexpr std::array<std::uint8_t, 4> kMagic = {0x28, 0xB5, 0x2F, 0xFD};
  return message.size() >= kMagic.size() &&
         std::equal(kMagic.begin(), kMagic.end(), message.begin());
}

Result<ExpandedBytes> expanded_zstd(ByteView message) {
  const unsigned long long size = ZSTD_getFrameContentSize(message.data(), message.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN) return damaged();
  if (size > kMaxBytes) return too_large();
  ExpandedBytes content(size);
  const std::size_t written =
      ZSTD_decompress(content.data(), content.size(), message.data(), message.size());
  if (ZSTD_isError(written) != 0U || written != content.size()) return damaged();
  return content;
}

}  // namespace milepost::ros
