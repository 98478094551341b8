// What differs between an older build and the current one.
#include "schema/base/digest.h"
#include "server/catalog/build_changes.h"
#include "server/routes/answers.h"
#include "server/routes/lookup.h"
#include "server/routes/routes.h"

namespace milepost::server {

Result<Response> answer_changes(const Call& call) {
  const Result<std::shared_ptr<const ServedMap>> current = find_map(call.catalog, call.path[0]);
  if (!current) return current.error();
  const Result<std::string> from = call.query.text("from");
  if (!from) return from.error();
  const auto before = find_kept_build(call.catalog, call.path[0], *from);
  if (!before) return before.error();
  return current_json(document_of(changes_document(**before, **current)));
}

}  // namespace milepost::server
