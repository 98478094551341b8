#include "schema/tile/zstd_frame.h"

#include <zstd.h>
#include <zstd_errors.h>

#include <algorithm>
#include <array>
#include <memory>
#include <new>
#include <string>

namespace milepost {
namespace {

constexpr int kCompressionLevel = 19;
constexpr std::size_t kBlockHeaderBytes = 3;
constexpr std::size_t kMaxFrameBytes = ZSTD_COMPRESSBOUND(kMaxTileContentBytes);
constexpr std::array<std::uint8_t, 4> kMagic = {0x28, 0xB5, 0x2F, 0xFD};

Error broken(const std::string& what) {
  return {ErrorCode::corrupt, "tile", what + " (FORMAT.md 3.2)",
          "fetch the tile again or replace the map with a good copy"};
}

// Whether the available bytes match the magic number.
bool starts_as_frame(ByteView stream) {
  const auto length = std::min(stream.size(), kMagic.size());
  return std::equal(kMagic.begin(), kMagic.begin() + static_cast<std::ptrdiff_t>(length),
                    stream.begin());
}

// Bit 2 of the frame header descriptor, the byte after the magic number (RFC 8878, 3.1.1.1.1).
bool has_checksum(ByteView frame) { return (frame[kMagic.size()] & 4U) != 0; }

// Checks the content size in the frame header. REQUIRES: the header is complete.
Status check_content_size(ByteView frame) {
  const unsigned long long size = ZSTD_getFrameContentSize(frame.data(), frame.size());
  if (size == ZSTD_CONTENTSIZE_ERROR) return broken("the frame header is damaged");
  if (size == ZSTD_CONTENTSIZE_UNKNOWN)
    return broken("the frame does not state its content's size");
  if (size > kMaxTileContentBytes) return broken("the frame states more than 16 MiB of content");
  return ok_status();
}

struct ContextDeleter {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

}  // namespace

Bytes compress_frame(ByteView content, std::span<const std::size_t> cuts) {
  const std::unique_ptr<ZSTD_CCtx, ContextDeleter> context(ZSTD_createCCtx());
  if (!context) throw std::bad_alloc();
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kCompressionLevel);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  ZSTD_CCtx_setPledgedSrcSize(context.get(), content.size());
  Bytes frame(ZSTD_compressBound(content.size()) + kBlockHeaderBytes * cuts.size());
  ZSTD_outBuffer output = {frame.data(), frame.size(), 0};
  ZSTD_inBuffer input = {content.data(), 0, 0};
  const auto compress_up_to = [&](std::size_t end, ZSTD_EndDirective directive) {
    input.size = end;
    const std::size_t left = ZSTD_compressStream2(context.get(), &output, &input, directive);
    if (left != 0) throw std::bad_alloc();  // the only remaining failure
  };
  for (const std::size_t cut : cuts) compress_up_to(cut, ZSTD_e_flush);
  compress_up_to(content.size(), ZSTD_e_end);
  frame.resize(output.pos);
  return frame;
}

Result<std::size_t> frame_length(ByteView stream) {
  if (!starts_as_frame(stream)) return broken("no zstd frame starts here");
  const std::size_t length = ZSTD_findFrameCompressedSize(stream.data(), stream.size());
  const bool incomplete = ZSTD_getErrorCode(length) == ZSTD_error_srcSize_wrong;
  if (ZSTD_isError(length) && !incomplete) return broken("the frame is damaged");
  if ((incomplete ? stream.size() : length) > kMaxFrameBytes) {
    return broken("the frame is longer than one of 16 MiB of content can be");
  }
  return incomplete ? 0 : length;
}

Result<Bytes> expand_frame(ByteView frame) {
  const Result<std::size_t> length = frame_length(frame);
  if (!length) return length.error();
  if (*length == 0) return broken("the frame is truncated");
  if (*length < frame.size()) return broken("bytes follow the frame");
  if (!has_checksum(frame)) return broken("the frame has no checksum");
  const Status size = check_content_size(frame);
  if (!size.ok()) return size.error();

  Bytes content(ZSTD_getFrameContentSize(frame.data(), frame.size()));
  const std::size_t expanded =
      ZSTD_decompress(content.data(), content.size(), frame.data(), frame.size());
  if (ZSTD_isError(expanded)) {
    return broken(std::string("the frame cannot be decompressed: ") + ZSTD_getErrorName(expanded));
  }
  if (expanded != content.size()) return broken("the frame holds less than it states");
  return content;
}

}  // namespace milepost
