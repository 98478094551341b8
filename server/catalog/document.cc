#include "server/catalog/document.h"

#include "schema/base/digest.h"

namespace milepost::server {

Document document_of(std::string text) {
  Document document;
  document.digest = digest_of(as_bytes(text));
  document.text = std::make_shared<const std::string>(std::move(text));
  return document;
}

}  // namespace milepost::server
