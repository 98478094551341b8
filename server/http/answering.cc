#include "server/http/answering.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <exception>
#include <string>
#include <string_view>
#include <utility>

#include "server/hot/forms.h"
#include "server/hot/frames_of.h"
#include "server/log/printable.h"
#include "server/routes/guard.h"
#include "server/routes/handle.h"

namespace milepost::server {
namespace {

// Their answers are parts of the catalog, or constant.
constexpr std::array<std::string_view, 5> kWithoutDisk = {"/healthz", "/readyz", "/metrics",
                                                          "/openapi.yaml", "/v1/maps"};

bool asks_for_content(const Request& request) {
  return request.method == "GET" || request.method == "HEAD";
}

// The answer without regard to other fields of the request.
Response unconditional(const Request& request, const Grant& grant, const Catalog& catalog,
                       const Shared& shared) {
  try {
    Response response =
        handle({request.method, request.target}, catalog,
               shared.viewer == nullptr ? Viewer::plain() : *shared.viewer, shared.metrics, grant);
    if (response.status == 500) spdlog::error("{}", printable(problem_detail(response)));
    if (has_codings(response)) response.headers.emplace_back("Vary", "Accept-Encoding");
    const bool is_for_all = response.guard == Guard::open || !shared.access.asks_for_tokens();
    return is_for_all ? std::move(response) : for_one_client(std::move(response));
  } catch (const std::exception& failure) {
    spdlog::error("{} {}: {}", printable(request.method), printable(request.target),
                  failure.what());
    return problem(500, "the server failed on this request; its log says why");
  }
}

// Whether the answer lists what the grant is for: no other grant has the same.
bool depends_on(const Grant& grant, const Response& response) {
  return response.guard == Guard::catalog && !grant.is_for_everything();
}

// Whether the answer is the same as long as the catalog is: signatures come while maps are served.
bool is_of_catalog_alone(const Response& response) {
  return !response.route.ends_with("/manifest.sig");
}

// Neither a map nor a long list is read for it. Without a valid token there is nothing to read.
bool needs_no_disk(const Request& request, const Grant& grant) {
  if (!asks_for_content(request) || !grant.is_valid()) return true;
  if (request.target == "/v1/maps" && !grant.is_for_everything()) return false;
  return std::ranges::find(kWithoutDisk, request.target) != kWithoutDisk.end();
}

// Null if it is not in memory.
PreparedAnswer found_in_memory(const Request& request, const Grant& grant,
                               const std::shared_ptr<const Catalog>& catalog, Shared& shared) {
  PreparedAnswer found =
      asks_for_content(request) ? shared.answers.find(request.target, catalog) : nullptr;
  if (found) {
    auto refused = refusal(grant, found->response.guard, found->response.map);
    if (refused) return prepared(std::move(*refused));
    return depends_on(grant, found->response) ? nullptr : found;
  }
  if (!needs_no_disk(request, grant)) return nullptr;
  found = prepared(unconditional(request, grant, *catalog, shared));
  if (asks_for_content(request)) shared.answers.add(request.target, catalog, found);
  return found;
}

ContentCoding coding_for(const Request& request, const Response& response) {
  return has_codings(response) ? preferred_coding(request.accept_encoding)
                               : ContentCoding::identity;
}

// Where HotAnswers have a document in a coding; no target begins so.
std::string coded_target(const Request& request, ContentCoding coding) {
  return std::string(name_of(coding)) + ' ' + request.target;
}

// What is sent of an answer that was found in `form`.
PreparedAnswer selected(const PreparedAnswer& found, const PreparedAnswer& form,
                        const Request& request) {
  for (const PreparedAnswer& known : {found, form}) {
    const PreparedAnswer& answer = unless_known(known, request.if_none_match);
    if (answer != known) return answer;
  }
  return part_for(form, request);
}

}  // namespace

Answer answer_from_memory(const Request& request, const Grant& grant, Shared& shared) {
  const std::shared_ptr<const Catalog> catalog = shared.catalog->now();
  const PreparedAnswer found = found_in_memory(request, grant, catalog, shared);
  if (!found) return {};
  const ContentCoding coding = coding_for(request, found->response);
  const PreparedAnswer form = coding == ContentCoding::identity
                                  ? found
                                  : shared.answers.find(coded_target(request, coding), catalog);
  if (!form) return {};
  const PreparedAnswer chosen = selected(found, form, request);
  Answer answer;
  if (frame_count(chosen->response) > 0) {
    answer.map = chosen->map.lock();
    if (!answer.map) return {};  // it is no longer in memory, nor are the entries of its tiles
    Frame first = shared.frames.find(frame_digest(chosen->response, 0));
    if (!first) return {};
    answer.frames.push_back(std::move(first));
  }
  answer.prepared = chosen;
  return answer;
}

Answer answer_from_disk(const Request& request, const Grant& grant, Shared& shared) {
  const std::shared_ptr<const Catalog> catalog = shared.catalog->now();
  Response response = unconditional(request, grant, *catalog, shared);
  std::shared_ptr<const ServedMap> map = map_of(response);
  const PreparedAnswer found = prepared(std::move(response));
  const bool is_to_be_kept = asks_for_content(request) && is_of_catalog_alone(found->response) &&
                             !depends_on(grant, found->response);
  if (is_to_be_kept) shared.answers.add(request.target, catalog, found);
  const ContentCoding coding = coding_for(request, found->response);
  PreparedAnswer form = found;
  if (coding != ContentCoding::identity) {
    Result<PreparedAnswer> in_its_coding = in_coding(found, coding);
    if (!in_its_coding) spdlog::error("{}", in_its_coding.error().line());
    if (in_its_coding) form = *in_its_coding;
    if (in_its_coding && is_to_be_kept)
      shared.answers.add(coded_target(request, coding), catalog, form);
  }
  const PreparedAnswer chosen = selected(found, form, request);
  if (frame_count(chosen->response) == 0) return {chosen, {}, std::move(map)};
  Result<std::vector<Frame>> frames = read_frames(chosen->response, *map, 0, shared.frames);
  if (frames) return {chosen, std::move(frames).value(), std::move(map)};
  spdlog::error("{}", frames.error().line());
  return {prepared(problem(500, "the map cannot be read; the server's log says why")), {}, nullptr};
}

}  // namespace milepost::server
