// The server's responses to any request line: "METHOD\nIF-NONE-MATCH\nTARGET".
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "server/hot/frames_of.h"
#include "server/hot/prepared.h"
#include "server/message/head.h"
#include "server/routes/handle.h"
#include "tests/fuzz/check.h"
#include "tests/server/test_map.h"

namespace {

using namespace milepost;
using namespace milepost::server;

const Catalog& catalog() {
  static const TemporaryFolder folder;
  static const std::shared_ptr<const Catalog> opened = [] {
    write_lane(folder.path() / "town.map");
    return open_catalog(folder.path());
  }();
  return *opened;
}

// Removes and returns the text up to the next line end.
std::string next_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string line(text.substr(0, end));
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  Request request;
  request.method = next_line(text);
  request.if_none_match = next_line(text);
  request.target = std::string(text);
  const Response response = handle(request, catalog());
  fuzz::check(response.status >= 200 && response.status < 500);
  const std::string head = head_of(response);
  fuzz::check(head.find("\r\n\r\n") == std::string::npos);  // no input can end the head early
  static HotFrames memory(1U << 20U);
  const auto* body = std::get_if<SharedText>(&response.body);
  std::uint64_t bytes = body != nullptr && *body != nullptr ? (*body)->size() : 0;
  for (std::size_t i = 0; i < frame_count(response);) {
    const Result<std::vector<Frame>> frames = read_frames(response, *map_of(response), i, memory);
    fuzz::check(frames.ok() && !frames->empty());
    for (const Frame& frame : *frames) bytes += frame->size();
    i += frames->size();
  }
  fuzz::check(bytes == response.content_length());
  return 0;
}
