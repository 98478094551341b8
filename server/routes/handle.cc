#include "server/routes/handle.h"

#include <array>
#include <optional>
#include <string>

#include "server/message/conditional.h"
#include "server/message/target.h"
#include "server/routes/guard.h"
#include "server/routes/routes.h"

namespace milepost::server {
namespace {

struct Route {
  std::string_view pattern;
  Guard guard;
  std::vector<std::string_view> parameters;  // of the query
  Result<Response> (*answer)(const Call&);
};

const std::vector<Route>& routes() {
  using enum Guard;
  static const std::vector<Route> table = {
      {"/healthz", open, {}, answer_health},
      {"/readyz", open, {}, answer_ready},
      {"/metrics", operators, {}, answer_metrics},
      {"/openapi.yaml", open, {}, answer_openapi},
      {"/", open, {}, answer_page},
      {"/viewer/{release}/{file}", open, {}, answer_viewer_file},
      {"/viewer/maps/{map}/builds/{build}/segments/{segment}/landmarks/{index}",
       map,
       {},
       answer_viewer_landmarks},
      {"/viewer/maps/{map}/builds/{build}/walls/{cell}", map, {}, answer_viewer_walls},
      {"/v1/maps", catalog, {}, answer_maps},
      {"/v1/maps/{map}", map, {}, answer_map},
      {"/v1/maps/{map}/changes", map, {"from"}, answer_changes},
      {"/v1/segments", catalog, {"near", "radius_m"}, answer_segments_near},
      {"/v1/maps/{map}/builds/{build}/manifest", map, {}, answer_manifest},
      {"/v1/maps/{map}/builds/{build}/manifest.sig", map, {}, answer_signature},
      {"/v1/maps/{map}/builds/{build}/map", map, {}, answer_summary},
      {"/v1/maps/{map}/builds/{build}/mapping", map, {}, answer_mapping},
      {"/v1/maps/{map}/builds/{build}/segments/{segment}", map, {}, answer_segment},
      {"/v1/maps/{map}/builds/{build}/segments/{segment}/tiles",
       map,
       {"layer", "from_m", "to_m"},
       answer_tile_range},
      {"/v1/maps/{map}/builds/{build}/segments/{segment}/tiles/{layer}/{index}",
       map,
       {},
       answer_tile},
      {"/v1/maps/{map}/builds/{build}/areas", map, {}, answer_areas},
      {"/v1/maps/{map}/builds/{build}/areas/{layer}", map, {"bbox"}, answer_cell_range},
      {"/v1/maps/{map}/builds/{build}/areas/{layer}/{cell}", map, {}, answer_cell},
  };
  return table;
}

// The values of the pattern's {braces} if the path matches it.
std::optional<std::vector<std::string>> fit(std::string_view pattern,
                                            const std::vector<std::string>& path) {
  std::vector<std::string> values;
  for (const std::string& segment : path) {
    if (!pattern.starts_with('/')) return std::nullopt;
    pattern.remove_prefix(1);
    const std::string_view expected = pattern.substr(0, pattern.find('/'));
    if (expected.starts_with('{') && !segment.empty()) {
      values.push_back(segment);
    } else if (expected != segment) {
      return std::nullopt;
    }
    pattern.remove_prefix(expected.size());
  }
  return pattern.empty() ? std::optional(std::move(values)) : std::nullopt;
}

constexpr const char* kMethods = "GET, HEAD, OPTIONS";

Response method_not_allowed(const std::string& method) {
  Response response =
      problem(405, "method " + method + ": is not allowed here; use GET, HEAD or OPTIONS");
  response.headers.emplace_back("Allow", kMethods);
  return response;
}

// To OPTIONS (RFC 9110, section 9.3.7).
Response methods() {
  Response response;
  response.status = 204;
  response.headers = {{"Allow", kMethods}};
  return response;
}

Response answer(const Route& route, const std::string& map, const Request& request,
                const Call& call) {
  if (request.method == "OPTIONS") return methods();
  if (request.method != "GET" && request.method != "HEAD") {
    return method_not_allowed(request.method);
  }
  if (auto refused = refusal(call.grant, route.guard, map)) return std::move(*refused);
  const Status allowed = call.query.allow_only(route.parameters);
  if (!allowed) return problem(allowed.error());
  Result<Response> response = route.answer(call);
  if (!response) return problem(response.error());
  return unless_known(std::move(*response), request.if_none_match);
}

}  // namespace

const Metrics& no_metrics() {
  static const Metrics none(path_patterns());
  return none;
}

Response handle(const Request& request, const Catalog& catalog, const Viewer& viewer,
                const Metrics& metrics, const Grant& grant) {
  if (request.target.size() > kMaxTargetBytes) {
    return problem(414, "the URL is longer than " + std::to_string(kMaxTargetBytes) +
                            " bytes; no URL of this server is");
  }
  if (request.method == "OPTIONS" && request.target == "*") return methods();
  const Result<Target> target = Target::parse(request.target);
  if (!target) return problem(target.error());
  for (const Route& route : routes()) {
    std::optional<std::vector<std::string>> values = fit(route.pattern, target->path);
    if (!values) continue;
    const bool names_map = route.pattern.find("/maps/{map}") != std::string_view::npos;
    std::string map = names_map ? values->front() : std::string();
    Response response = answer(
        route, map, request, {catalog, std::move(*values), target->query, viewer, metrics, grant});
    response.route = route.pattern;
    response.guard = route.guard;
    response.map = std::move(map);
    return response;
  }
  return problem(404, "there is nothing at this path; /openapi.yaml lists the paths");
}

std::vector<std::string_view> path_patterns() {
  std::vector<std::string_view> patterns;
  for (const Route& route : routes()) patterns.push_back(route.pattern);
  return patterns;
}

}  // namespace milepost::server
