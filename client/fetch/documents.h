// Parsers of the server's JSON documents (PROTOCOL.md). Every field is validated.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "client/fetch/map_source.h"
#include "schema/base/result.h"
#include "schema/store/map_store.h"

namespace milepost {

// A segment and its tiles: the tile index of each layer, ascending.
struct SegmentDocument {
  SegmentDescription description;
  std::map<std::string, std::vector<TileEntry>> tiles;
};

// The cells of each layer that has any, ascending.
using AreasDocument = std::map<std::string, std::vector<CellEntry>>;

// A segment that a static store lists, and the box around its line: a hint.
struct PlacedSegment {
  MapVersion version;
  std::string segment;
  Bounds bounds;
};

// Whether the document says that a static store sends it, which answers no query.
bool is_of_static_store(std::string_view text);

// `where` (the document's URL) is used in error messages. Errors of all: corrupt, also for a
// document about something else than what was requested. The documents of a build name neither
// their map nor their build; the caller knows these by the digest.
Result<std::vector<MapVersion>> parse_catalog_document(std::string_view text,
                                                       const std::string& where);
Result<std::vector<NearbySegment>> parse_nearby_document(std::string_view text,
                                                         const std::string& where);
// What a static store sends in place of the nearby segments: all of them.
Result<std::vector<PlacedSegment>> parse_placed_segments(std::string_view text,
                                                         const std::string& where);
Result<MapDescription> parse_map_document(std::string_view text, const std::string& where,
                                          const MapVersion& version);
Result<SegmentDocument> parse_segment_document(std::string_view text, const std::string& where,
                                               const MapVersion& version,
                                               const std::string& segment);
Result<AreasDocument> parse_areas_document(std::string_view text, const std::string& where);

// The entries whose arc length range meets `range`.
std::vector<TileEntry> entries_meeting(const std::vector<TileEntry>& index,
                                       const AlongRange& range);
// The entries whose cell meets `box`.
std::vector<CellEntry> entries_meeting(const std::vector<CellEntry>& index, const Bounds& box);

// The total size of the tiles of the index.
std::uint64_t bytes_of(const std::vector<TileEntry>& index);

}  // namespace milepost
