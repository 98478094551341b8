#include "server/http/exchange.h"

#include <spdlog/spdlog.h>

#include "server/log/printable.h"

namespace milepost::server {

void observe(const Exchange& exchange, Metrics& metrics) {
  metrics.count({exchange.route, exchange.map, exchange.status, exchange.body_bytes, exchange.tiles,
                 exchange.took, exchange.aborted});
  if (!spdlog::should_log(spdlog::level::info)) return;
  spdlog::info("{}{}{} \"{} {}\" {} {} bytes {:.1f} ms{}", exchange.peer,
               exchange.token.empty() ? "" : " ", exchange.token, printable(exchange.method),
               printable(exchange.target), exchange.status, exchange.body_bytes,
               std::chrono::duration<double, std::milli>(exchange.took).count(),
               exchange.aborted ? ", aborted" : "");
}

}  // namespace milepost::server
