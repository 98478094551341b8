#include "client/fetch/frame_fetcher.h"

#include <utility>

namespace milepost {
namespace {

std::uint64_t bytes_of(const std::vector<ExpectedFrame>& frames) {
  std::uint64_t bytes = 0;
  for (const ExpectedFrame& frame : frames) bytes += frame.bytes;
  return bytes;
}

CacheKey key_of(CacheKey layer_key, std::uint32_t number) {
  layer_key.number = number;
  return layer_key;
}

}  // namespace

std::optional<Bytes> FrameFetcher::find(const CacheKey& layer_key, const ExpectedFrame& frame) {
  auto cached = cache_.find(key_of(layer_key, frame.number), frame.digest);
  if (cached) ++from_cache_;
  return cached;
}

Result<std::map<std::uint32_t, Bytes>> FrameFetcher::fetch(const CacheKey& layer_key,
                                                           const std::vector<ExpectedFrame>& wanted,
                                                           const RequestFor& request_for,
                                                           const Stopped& stopped) {
  std::map<std::uint32_t, Bytes> frames;
  std::set<std::uint32_t> missing;
  for (const ExpectedFrame& frame : wanted) {
    if (auto cached = find(layer_key, frame)) {
      frames[frame.number] = std::move(*cached);
    } else {
      missing.insert(frame.number);
    }
  }
  const FrameSink take = [&](std::uint32_t number, const Bytes& frame) {
    frames[number] = frame;
    return missing.erase(number) > 0;
  };
  while (!missing.empty()) {
    const Status fetched = with_retries(requests_.retry(), stopped, [&] {
      return fetch_once(layer_key, request_for(missing), take, stopped);
    });
    if (!fetched.ok()) return fetched.error();
  }
  return frames;
}

Attempt FrameFetcher::fetch_once(const CacheKey& layer_key, const FrameRequest& request,
                                 const FrameSink& take, const Stopped& stopped) {
  bool advanced = false;
  FrameCutter cutter(request.url, request.expected, [&](std::uint32_t number, const Bytes& frame) {
    ++from_server_;
    cache_.store(key_of(layer_key, number), frame);
    if (take(number, frame)) advanced = true;
  });
  HttpAnswer answer = requests_.get(
      request.url, bytes_of(request.expected), [&](ByteView piece) { return cutter.take(piece); },
      stopped);
  if (answer.status.ok()) return {cutter.finish()};
  // Whole frames of an answer that broke off are kept, and the next request asks for the rest.
  if (advanced && answer.status.error().code == ErrorCode::unavailable) return {};
  return {std::move(answer.status), answer.retry_after_s};
}

}  // namespace milepost
