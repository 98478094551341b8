#include "server/message/content_coding.h"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <optional>

#include "server/message/letters.h"

namespace milepost::server {
namespace {

constexpr int kGzipLevel = 6;
constexpr int kGzipWindow = 15 + 16;  // zlib's largest; 16 asks for gzip's header
constexpr int kGzipMemory = 8;
constexpr int kZstdLevel = 9;

std::string_view trimmed_item(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

// Removes and returns the text before `separator`, or all of it.
std::string_view take_until(std::string_view& text, char separator) {
  const std::size_t end = std::min(text.find(separator), text.size());
  const std::string_view item = trimmed_item(text.substr(0, end));
  text.remove_prefix(std::min(end + 1, text.size()));
  return item;
}

// "0.25", at most three decimals, in thousandths.
std::optional<int> weight_in(std::string_view text) {
  if (text.empty() || text.size() > 5 || (text[0] != '0' && text[0] != '1')) return std::nullopt;
  if (text.size() > 1 && text[1] != '.') return std::nullopt;
  int thousandths = (text[0] - '0') * 1000;
  int unit = 100;
  for (const char digit : text.substr(std::min<std::size_t>(2, text.size()))) {
    if (digit < '0' || digit > '9') return std::nullopt;
    thousandths += (digit - '0') * unit;
    unit /= 10;
  }
  return thousandths <= 1000 ? std::optional(thousandths) : std::nullopt;
}

struct Weights {
  std::optional<int> gzip, zstd, identity, any;
  std::optional<int> of(ContentCoding coding) const {
    const auto& own = coding == ContentCoding::gzip   ? gzip
                      : coding == ContentCoding::zstd ? zstd
                                                      : identity;
    return own ? own : any;
  }
};

std::optional<Weights> weights_in(std::string_view field) {
  Weights weights;
  while (!field.empty()) {
    std::string_view item = take_until(field, ',');
    if (item.empty()) continue;
    const std::string_view name = take_until(item, ';');
    item = trimmed_item(item);
    std::optional<int> weight = 1000;
    if (!item.empty()) {
      const bool has_weight = item.starts_with("q=") || item.starts_with("Q=");
      weight = has_weight ? weight_in(item.substr(2)) : std::nullopt;
    }
    if (!weight) return std::nullopt;
    if (equals_lower(name, "gzip") || equals_lower(name, "x-gzip")) weights.gzip = weight;
    if (equals_lower(name, "zstd")) weights.zstd = weight;
    if (equals_lower(name, "identity")) weights.identity = weight;
    if (name == "*") weights.any = weight;
  }
  return weights;
}

Error short_of_memory() {
  return {ErrorCode::io, "a document", "cannot be compressed: memory is short",
          "give the server more memory"};
}

Result<std::string> in_gzip(std::string_view text) {
  z_stream stream{};
  if (deflateInit2(&stream, kGzipLevel, Z_DEFLATED, kGzipWindow, kGzipMemory, Z_DEFAULT_STRATEGY) !=
      Z_OK) {
    return short_of_memory();
  }
  std::string bytes(deflateBound(&stream, text.size()), '\0');
  // zlib does not change its input. NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  const bool is_done = deflate(&stream, Z_FINISH) == Z_STREAM_END;
  bytes.resize(stream.total_out);
  deflateEnd(&stream);
  if (!is_done) return short_of_memory();
  return bytes;
}

Result<std::string> in_zstd(std::string_view text) {
  std::string bytes(ZSTD_compressBound(text.size()), '\0');
  const std::size_t size =
      ZSTD_compress(bytes.data(), bytes.size(), text.data(), text.size(), kZstdLevel);
  if (ZSTD_isError(size) != 0) return short_of_memory();
  bytes.resize(size);
  return bytes;
}

}  // namespace

std::string_view name_of(ContentCoding coding) {
  constexpr std::array<std::string_view, 3> kNames = {"identity", "gzip", "zstd"};
  return kNames.at(static_cast<std::size_t>(coding));
}

ContentCoding preferred_coding(std::string_view accept_encoding) {
  const auto weights = weights_in(accept_encoding);
  if (!weights) return ContentCoding::identity;
  ContentCoding best = ContentCoding::identity;
  // What is not named is not accepted, but for identity, which always is.
  int best_weight = weights->identity.value_or(0);
  for (const ContentCoding coding : {ContentCoding::gzip, ContentCoding::zstd}) {
    const int weight = weights->of(coding).value_or(0);
    if (weight == 0 || weight < best_weight) continue;
    best = coding;
    best_weight = weight;
  }
  return best;
}

Result<std::string> coded(std::string_view text, ContentCoding coding) {
  switch (coding) {
    case ContentCoding::gzip:
      return in_gzip(text);
    case ContentCoding::zstd:
      return in_zstd(text);
    case ContentCoding::identity:
      break;
  }
  return std::string(text);
}

}  // namespace milepost::server
