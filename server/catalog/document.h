// A JSON document that is serialized once and sent many times.
#pragma once

#include <memory>
#include <string>

namespace milepost::server {

struct Document {
  std::shared_ptr<const std::string> text;
  std::string digest;  // of the text
};

Document document_of(std::string text);
// REQUIRES: `digest` is that of the text.
Document document_of(std::string text, std::string digest);

}  // namespace milepost::server
