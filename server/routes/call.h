// The arguments of a route: the catalog, the values in the path's braces, the query, and what the
// server shows of itself.
#pragma once

#include <string>
#include <vector>

#include "server/access/grant.h"
#include "server/catalog/catalog.h"
#include "server/message/target.h"
#include "server/metrics/metrics.h"
#include "server/viewer/viewer.h"

namespace milepost::server {

struct Call {
  const Catalog& catalog;
  std::vector<std::string> path;  // the values of {braces}, in the pattern's order
  const Query& query;             // only parameters of the route, none repeated
  const Viewer& viewer;
  const Metrics& metrics;
  const Grant& grant;  // of the request, which is for the route
};

}  // namespace milepost::server
