// The JSON documents that the client reads, from a server or from its cache. The first byte
// chooses which.
#include "client/fetch/documents.h"

#include <cstdint>
#include <string>
#include <string_view>

#include "schema/feature/codebook.h"
#include "schema/feature/types.h"
#include "tests/fuzz/check.h"

namespace {

using namespace milepost;

const MapVersion kVersion{"town", "00112233445566778899aabbccddeeff"};

// What a map document gives is read on where the vehicle opens a segment.
void read_map(std::string_view text) {
  const Result<MapDescription> map = parse_map_document(text, "fuzz", "town");
  if (!map) return;
  static_cast<void>(feature_parameters_from_json(map->feature_json));
  for (const auto& [name, parameters] : map->layers) {
    fuzz::check(!name.empty());
    static_cast<void>(Codebook::from_json(parameters));
  }
}

void read_segment(std::string_view text) {
  const Result<SegmentDocument> segment = parse_segment_document(text, "fuzz", kVersion, "s1");
  if (!segment) return;
  for (const auto& [layer, index] : segment->tiles) {
    fuzz::check(entries_meeting(index, {-1e8, 1e8}).size() == index.size());
  }
}

void read_areas(std::string_view text) {
  const Result<AreasDocument> areas = parse_areas_document(text, "fuzz", kVersion);
  if (!areas) return;
  for (const auto& [layer, index] : *areas) {
    fuzz::check(entries_meeting(index, {-180, -90, 180, 90}).size() == index.size());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0]) {
    case 'c':
      static_cast<void>(parse_catalog_document(text, "fuzz"));
      break;
    case 'n':
      static_cast<void>(parse_nearby_document(text, "fuzz"));
      break;
    case 'm':
      read_map(text);
      break;
    case 's':
      read_segment(text);
      break;
    case 'a':
      read_areas(text);
      break;
    case 'f':
      static_cast<void>(feature_parameters_from_json(std::string(text)));
      break;
    case 'b':
      static_cast<void>(Codebook::from_json(std::string(text)));
      break;
    default:
      break;
  }
  return 0;
}
