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

// The frames that a call collects.
struct FrameFetcher::Collection {
  const CacheKey& layer_key;
  std::set<std::uint32_t> missing = {};
  std::map<std::uint32_t, Bytes> frames = {};
};

Result<std::map<std::uint32_t, Bytes>> FrameFetcher::fetch(const CacheKey& layer_key,
                                                           const std::vector<ExpectedFrame>& wanted,
                                                           const RequestFor& request_for) {
  Collection collection{layer_key};
  for (const ExpectedFrame& frame : wanted) {
    if (auto cached = cache_.find(key_of(layer_key, frame.number), frame.digest)) {
      collection.frames[frame.number] = std::move(*cached);
      ++from_cache_;
    } else {
      collection.missing.insert(frame.number);
    }
  }
  while (!collection.missing.empty()) {
    const Status fetched = with_retries(
        requests_.retry(), [&] { return fetch_once(request_for(collection.missing), collection); });
    if (!fetched.ok()) return fetched.error();
  }
  return std::move(collection.frames);
}

Attempt FrameFetcher::fetch_once(const FrameRequest& request, Collection& collection) {
  const std::size_t missing_before = collection.missing.size();
  FrameCutter cutter(request.url, request.expected, [&](std::uint32_t number, Bytes frame) {
    take_from_server(number, std::move(frame), collection);
  });
  HttpAnswer answer = requests_.get(request.url, bytes_of(request.expected),
                                    [&](ByteView piece) { return cutter.take(piece); });
  if (answer.status.ok()) return {cutter.finish()};
  // Whole frames of an answer that broke off are kept, and the next request asks for the rest.
  const bool advanced = collection.missing.size() < missing_before;
  if (advanced && answer.status.error().code == ErrorCode::unavailable) return {};
  return {std::move(answer.status), answer.retry_after_s};
}

void FrameFetcher::take_from_server(std::uint32_t number, Bytes frame, Collection& collection) {
  ++from_server_;
  cache_.store(key_of(collection.layer_key, number), frame);
  collection.missing.erase(number);
  collection.frames[number] = std::move(frame);
}

}  // namespace milepost
