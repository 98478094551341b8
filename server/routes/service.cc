// Routes about the server itself.
#include "server/routes/answers.h"
#include "server/routes/openapi.h"
#include "server/routes/routes.h"

namespace milepost::server {

Result<Response> answer_health(const Call&) { return plain_text("ok\n"); }

// "ok" and what is not: a map left out, or damaged since it was opened, a line each. Who has no
// token for everything is not told which.
Result<Response> answer_ready(const Call& call) {
  std::string faults;
  for (const auto& [file, error] : call.catalog.left_out_files())
    faults += "left out: " + error.line() + "\n";
  for (const auto& [map, error] : call.catalog.faults())
    faults += "damaged: build " + map.second + " of map " + map.first + ": " + error.line() + "\n";
  const bool is_ready = faults.empty() || !call.catalog.settings().all_must_be_served;
  if (!call.grant.is_for_everything()) faults.clear();
  Response response = plain_text((is_ready ? "ok\n" : "not ready\n") + faults);
  if (!is_ready) {
    response.status = 503;
    response.headers.emplace_back("Retry-After", "10");
  }
  return response;
}

Result<Response> answer_metrics(const Call& call) {
  Response response = plain_text(call.metrics.text(call.catalog));
  response.headers.front().second = "text/plain; version=0.0.4; charset=utf-8";
  return response;
}

Result<Response> answer_openapi(const Call&) {
  static const Document document = document_of(std::string(openapi_yaml()));
  return current_text(document, "application/yaml");
}

}  // namespace milepost::server
