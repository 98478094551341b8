// headers.json of a published tree: which header fields each file is to be served with.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "schema/base/result.h"

namespace milepost::server {

// Files that are served with the same fields, apart from their ETag.
struct HeaderGroup {
  const char* name;
  std::vector<const char*> patterns;  // of paths, as rclone's filters: * is any name, without a /
  const char* content_type;
  const char* cache_control;
};

// Every file of a tree is in exactly one.
const std::vector<HeaderGroup>& header_groups();

// Path of a file, relative to the tree -> its ETag, without the quotes.
using EntityTags = std::map<std::string, std::string>;

std::string headers_document(const EntityTags& files);

// The files in such a document. Errors: corrupt, with `where` empty.
Result<EntityTags> entity_tags_in(std::string_view document);

}  // namespace milepost::server
