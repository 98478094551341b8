#include "server/http/answering.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <exception>
#include <string_view>
#include <utility>

#include "server/hot/frames_of.h"
#include "server/log/printable.h"
#include "server/routes/handle.h"

namespace milepost::server {
namespace {

// Their answers are parts of the catalog, or constant.
constexpr std::array<std::string_view, 4> kWithoutDisk = {"/healthz", "/readyz", "/openapi.yaml",
                                                          "/v1/maps"};

bool asks_for_content(const Request& request) {
  return request.method == "GET" || request.method == "HEAD";
}

// The answer without regard to If-None-Match.
Response unconditional(const Request& request, const Catalog& catalog) {
  try {
    return handle({request.method, request.target, {}}, catalog);
  } catch (const std::exception& failure) {
    spdlog::error("{} {}: {}", printable(request.method), printable(request.target),
                  failure.what());
    return problem(500, "the server failed on this request; its log says why");
  }
}

}  // namespace

PreparedAnswer answer_from_memory(const Request& request, Shared& shared) {
  if (!asks_for_content(request)) return nullptr;
  const std::shared_ptr<const Catalog> catalog = shared.catalog->now();
  PreparedAnswer answer = shared.answers.find(request.target, catalog);
  if (!answer) {
    const auto found = std::ranges::find(kWithoutDisk, request.target);
    if (found == kWithoutDisk.end()) return nullptr;
    answer = prepared(unconditional(request, *catalog));
    shared.answers.add(request.target, catalog, answer);
  }
  return unless_known(answer, request.if_none_match);
}

Answer answer_from_disk(const Request& request, Shared& shared) {
  const std::shared_ptr<const Catalog> catalog = shared.catalog->now();
  Answer answer{prepared(unconditional(request, *catalog)), {}};
  if (asks_for_content(request)) shared.answers.add(request.target, catalog, answer.prepared);
  answer.prepared = unless_known(answer.prepared, request.if_none_match);
  if (request.method == "HEAD" || frame_count(answer.prepared->response) == 0) return answer;
  Result<std::vector<Frame>> frames = read_frames(answer.prepared->response, 0, shared.frames);
  if (!frames) return {unreadable(frames.error()), {}};
  answer.frames = std::move(frames).value();
  return answer;
}

PreparedAnswer unreadable(const Error& error) {
  spdlog::error("{}", error.line());
  return prepared(problem(500, "the map cannot be read; the server's log says why"));
}

}  // namespace milepost::server
