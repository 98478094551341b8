// Request handling as a pure function: no sockets, no clock, no state.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "server/access/grant.h"
#include "server/catalog/catalog.h"
#include "server/message/request.h"
#include "server/message/response.h"
#include "server/metrics/metrics.h"
#include "server/viewer/viewer.h"

namespace milepost::server {

// A longer target is answered with 414.
inline constexpr std::size_t kMaxTargetBytes = 4096;

// That have counted nothing.
const Metrics& no_metrics();

// The response to a request (PROTOCOL.md) that has this grant, without regard to Authorization,
// Range and Accept-Encoding. HEAD gets the response to GET; the sender omits the
// body. Safe to call from several threads at once. The response keeps alive what it refers to.
Response handle(const Request& request, const Catalog& catalog,
                const Viewer& viewer = Viewer::plain(), const Metrics& metrics = no_metrics(),
                const Grant& grant = Grant::everything());

// The paths of all routes, as in openapi.yaml: "/v1/maps/{map}".
std::vector<std::string_view> path_patterns();

}  // namespace milepost::server
