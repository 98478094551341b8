// Routes about the server itself.
#include "server/routes/answers.h"
#include "server/routes/openapi.h"
#include "server/routes/routes.h"

namespace milepost::server {

Result<Response> answer_health(const Call&) { return plain_text("ok\n"); }

// The catalog is open before the server listens, so the server is always ready.
Result<Response> answer_ready(const Call&) { return plain_text("ok\n"); }

Result<Response> answer_openapi(const Call&) {
  static const Document document = document_of(std::string(openapi_yaml()));
  return current_text(document, "application/yaml");
}

}  // namespace milepost::server
