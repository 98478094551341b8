#include "server/catalog/document.h"

#include "schema/base/digest.h"

namespace milepost::server {

Document document_of(std::string text) {
  std::string digest = digest_of(as_bytes(text));
  return document_of(std::move(text), std::move(digest));
}

Document document_of(std::string text, std::string digest) {
  return {std::make_shared<const std::string>(std::move(text)), std::move(digest)};
}

}  // namespace milepost::server
