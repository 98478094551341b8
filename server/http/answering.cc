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
constexpr std::array<std::string_view, 5> kWithoutDisk = {"/healthz", "/readyz", "/metrics",
                                                          "/openapi.yaml", "/v1/maps"};

bool asks_for_content(const Request& request) {
  return request.method == "GET" || request.method == "HEAD";
}

// The answer without regard to If-None-Match.
Response unconditional(const Request& request, const Catalog& catalog, const Shared& shared) {
  try {
    Response response =
        handle({request.method, request.target, {}}, catalog,
               shared.viewer == nullptr ? Viewer::plain() : *shared.viewer, shared.metrics);
    if (response.status == 500) spdlog::error("{}", printable(problem_detail(response)));
    return response;
  } catch (const std::exception& failure) {
    spdlog::error("{} {}: {}", printable(request.method), printable(request.target),
                  failure.what());
    return problem(500, "the server failed on this request; its log says why");
  }
}

// Whether the answer is the same as long as the catalog is: signatures come while maps are served.
bool is_of_catalog_alone(const Response& response) {
  return !response.route.ends_with("/manifest.sig");
}

// Null if it is not in memory.
PreparedAnswer hot_answer(const Request& request, Shared& shared) {
  const std::shared_ptr<const Catalog> catalog = shared.catalog->now();
  PreparedAnswer hot = shared.answers.find(request.target, catalog);
  if (hot) return hot;
  if (std::ranges::find(kWithoutDisk, request.target) == kWithoutDisk.end()) return nullptr;
  hot = prepared(unconditional(request, *catalog, shared));
  shared.answers.add(request.target, catalog, hot);
  return hot;
}

bool has_frames(const Request& request, const Response& response) {
  return request.method != "HEAD" && frame_count(response) > 0;
}

}  // namespace

Answer answer_from_memory(const Request& request, Shared& shared) {
  Answer answer;
  if (!asks_for_content(request)) return answer;
  const PreparedAnswer hot = hot_answer(request, shared);
  if (!hot) return answer;
  const PreparedAnswer& chosen = unless_known(hot, request.if_none_match);
  if (frame_count(chosen->response) > 0) {
    answer.map = chosen->map.lock();
    if (!answer.map) return {};  // it is no longer in memory, nor are the entries of its tiles
  }
  if (has_frames(request, chosen->response)) {
    Frame first = shared.frames.find(frame_digest(chosen->response, 0));
    if (!first) return {};
    answer.frames.push_back(std::move(first));
  }
  answer.prepared = chosen;
  return answer;
}

Answer answer_from_disk(const Request& request, Shared& shared) {
  const std::shared_ptr<const Catalog> catalog = shared.catalog->now();
  Response response = unconditional(request, *catalog, shared);
  std::shared_ptr<const ServedMap> map = map_of(response);
  const PreparedAnswer found = prepared(std::move(response));
  if (asks_for_content(request) && is_of_catalog_alone(found->response))
    shared.answers.add(request.target, catalog, found);
  const PreparedAnswer& chosen = unless_known(found, request.if_none_match);
  if (!has_frames(request, chosen->response)) return {chosen, {}, std::move(map)};
  Result<std::vector<Frame>> frames = read_frames(chosen->response, *map, 0, shared.frames);
  if (frames) return {chosen, std::move(frames).value(), std::move(map)};
  spdlog::error("{}", frames.error().line());
  return {prepared(problem(500, "the map cannot be read; the server's log says why")), {}, nullptr};
}

}  // namespace milepost::server
