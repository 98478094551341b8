// The manifest of a build: the digests of its documents, which hold those of its tiles. The build
// is the digest of the manifest's text, so whoever knows the build can check every byte of the map
// (FORMAT.md 7).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "schema/base/result.h"

namespace milepost {

inline constexpr std::uint64_t kMapFormat = 3;  // of FORMAT.md 2
// Limit of a document's length, to be checked before it is read.
inline constexpr std::uint64_t kMaxDocumentBytes = 64ULL << 20U;

// One document as the manifest lists it.
struct ListedDocument {
  std::uint64_t bytes = 0;
  std::string digest;

  static ListedDocument of(std::string_view text);
  // Whether the text is the document, byte by byte.
  bool is(std::string_view text) const;
};

struct Manifest {
  ListedDocument map;
  ListedDocument areas;
  std::map<std::string, ListedDocument> segments = {};  // by id
  std::optional<ListedDocument> mapping = {};
};

std::string manifest_document(const Manifest& manifest);

// The manifest in a text that has the build as its digest. Errors: corrupt, with `where` empty (it
// is no manifest, or one of another format).
Result<Manifest> manifest_from(std::string_view text);

}  // namespace milepost
