#include "client/fetch/documents.h"

#include <limits>
#include <optional>
#include <utility>

#include "client/fetch/json_fields.h"
#include "schema/base/digest.h"
#include "schema/base/ids.h"
#include "schema/store/map_checks.h"

namespace milepost {
namespace {

constexpr std::uint32_t kLastCell = kCellRows * kCellColumns - 1;

std::string segment_id(JsonFields& fields, const Json& object, const char* key) {
  std::string id = fields.text(object, key);
  if (fields.ok() && !is_segment_id(id)) fields.fail("\"" + id + "\" is not a segment id");
  return id;
}

MapVersion version_of(JsonFields& fields, const Json& json, const char* name_key) {
  MapVersion version{fields.text(json, name_key), fields.text(json, "build")};
  if (fields.ok() && !is_digest(version.build)) fields.fail("\"build\" is not a digest");
  return version;
}

GeoPoint vertex_of(JsonFields& fields, const Json& point) {
  return {fields.number_at(point, 0, -90, 90), fields.number_at(point, 1, -180, 180),
          fields.number_at(point, 2, -kMaxAltitudeM, kMaxAltitudeM)};
}

// A successor without a map is in that of the segment itself.
std::vector<Successor> successors_of(JsonFields& fields, const Json& json, const std::string& map) {
  std::vector<Successor> successors;
  for (const Json& successor : fields.array(json, "successors")) {
    const bool is_neighbour = successor.is_object() && successor.contains("map");
    successors.push_back({segment_id(fields, successor, "segment"),
                          is_neighbour ? segment_id(fields, successor, "map") : map});
  }
  return successors;
}

std::vector<StoredPass> passes_of(JsonFields& fields, const Json& json) {
  std::vector<StoredPass> passes;
  for (const Json& object : fields.array(json, "passes")) {
    StoredPass pass;
    pass.drive = segment_id(fields, object, "drive");
    pass.from_m = fields.number(object, "from_m", 0, kMaxAlongM);
    pass.to_m = fields.number(object, "to_m", pass.from_m, kMaxAlongM);
    passes.push_back(std::move(pass));
  }
  return passes;
}

PositionError position_error_of(JsonFields& fields, const Json& json) {
  const auto optional_m = [&](const char* key) {
    return json.contains(key) ? std::optional(fields.number(json, key, 0, kMaxAlongM))
                              : std::nullopt;
  };
  PositionError error{optional_m("position_sigma_m"), optional_m("position_correlation_m"), false};
  if (const auto assumed = json.find("assumed"); assumed != json.end()) {
    if (!assumed->is_boolean()) fields.fail("\"assumed\" is neither true nor false");
    error.is_assumed = assumed->is_boolean() && assumed->get<bool>();
  }
  return error;
}

// Reads the fields common to tiles and cells.
template <class Entry>
void read_stored(JsonFields& fields, const Json& json, Entry& entry) {
  entry.items = fields.whole(json, "items", kMaxItems);
  entry.bytes = fields.whole(json, "bytes", kMaxFrameBytes);
  entry.digest = fields.text(json, "digest");
  if (fields.ok() && entry.bytes == 0) fields.fail("a tile without bytes");
  if (fields.ok() && !is_digest(entry.digest)) fields.fail("\"digest\" is not a digest");
}

TileEntry tile_entry_of(JsonFields& fields, const Json& json) {
  TileEntry entry;
  entry.index = static_cast<std::uint32_t>(
      fields.whole(json, "index", std::numeric_limits<std::uint32_t>::max()));
  entry.along.from_m = fields.number(json, "from_m", -kMaxAlongM, kMaxAlongM);
  entry.along.to_m = fields.number(json, "to_m", entry.along.from_m, kMaxAlongM);
  read_stored(fields, json, entry);
  return entry;
}

CellEntry cell_entry_of(JsonFields& fields, const Json& json) {
  CellEntry entry;
  entry.cell = static_cast<std::uint32_t>(fields.whole(json, "cell", kLastCell));
  read_stored(fields, json, entry);
  return entry;
}

// The entries of a layer; must be ascending by `number_of`.
template <class Entry>
std::vector<Entry> index_of(JsonFields& fields, const Json& list,
                            Entry (*entry_of)(JsonFields&, const Json&),
                            std::uint32_t Entry::*number_of) {
  std::vector<Entry> index;
  if (!list.is_array()) fields.fail("a layer's tiles are not a list");
  for (const Json& json : list) {
    Entry entry = entry_of(fields, json);
    if (!index.empty() && entry.*number_of <= index.back().*number_of) {
      fields.fail("the tiles of a layer are not ascending");
    }
    if (!fields.ok()) return {};
    index.push_back(std::move(entry));
  }
  return index;
}

// The index of each layer in the object `key`.
template <class Entry>
std::map<std::string, std::vector<Entry>> indices_of(JsonFields& fields, const Json& json,
                                                     const char* key,
                                                     Entry (*entry_of)(JsonFields&, const Json&),
                                                     std::uint32_t Entry::*number_of) {
  std::map<std::string, std::vector<Entry>> indices;
  for (const auto& [layer, list] : fields.object(json, key).items()) {
    if (!is_layer_name(layer)) {
      fields.fail(std::string("\"") + key + "\" has a member that is not a layer name");
    }
    indices[layer] = index_of(fields, list, entry_of, number_of);
  }
  return indices;
}

Bounds bounds_of(JsonFields& fields, const Json& json) {
  Bounds bounds;
  bounds.west_deg = fields.number(json, "west_deg", -180, 180);
  bounds.south_deg = fields.number(json, "south_deg", -90, 90);
  bounds.east_deg = fields.number(json, "east_deg", bounds.west_deg, 180);
  bounds.north_deg = fields.number(json, "north_deg", bounds.south_deg, 90);
  return bounds;
}

void check_is_about(JsonFields& fields, const std::string& requested, const std::string& received) {
  if (fields.ok() && requested != received) {
    fields.fail("the document is about \"" + received + "\", but \"" + requested +
                "\" was requested");
  }
}

NearbySegment nearby_of(JsonFields& fields, const Json& json) {
  NearbySegment near;
  near.version = version_of(fields, json, "map");
  near.segment = segment_id(fields, json, "segment");
  near.length_m = fields.number(json, "length_m", 0, kMaxAlongM);
  near.along_m = fields.number(json, "along_m", 0, kMaxAlongM);
  near.distance_m = fields.number(json, "distance_m", 0, kMaxAlongM);
  return near;
}

}  // namespace

bool is_of_static_store(std::string_view text) {
  const Result<Json> json = read_ordered_json(text);
  if (!json || !json->is_object()) return false;
  const auto found = json->find("static");
  return found != json->end() && found->is_boolean() && found->get<bool>();
}

Result<std::vector<MapVersion>> parse_catalog_document(std::string_view text,
                                                       const std::string& where) {
  JsonFields fields(where);
  const Json json = fields.parsed(text);
  std::vector<MapVersion> maps;
  for (const Json& entry : fields.array(json, "maps")) {
    maps.push_back(version_of(fields, entry, "name"));
  }
  if (!fields.ok()) return fields.error();
  return maps;
}

Result<std::vector<NearbySegment>> parse_nearby_document(std::string_view text,
                                                         const std::string& where) {
  JsonFields fields(where);
  const Json json = fields.parsed(text);
  std::vector<NearbySegment> segments;
  for (const Json& entry : fields.array(json, "segments")) {
    segments.push_back(nearby_of(fields, entry));
  }
  if (!fields.ok()) return fields.error();
  return segments;
}

Result<std::vector<PlacedSegment>> parse_placed_segments(std::string_view text,
                                                         const std::string& where) {
  JsonFields fields(where);
  const Json json = fields.parsed(text);
  std::vector<PlacedSegment> segments;
  for (const Json& entry : fields.array(json, "segments")) {
    segments.push_back({version_of(fields, entry, "map"), segment_id(fields, entry, "segment"),
                        bounds_of(fields, fields.object(entry, "bounds"))});
  }
  if (!fields.ok()) return fields.error();
  return segments;
}

Result<MapDescription> parse_map_document(std::string_view text, const std::string& where,
                                          const MapVersion& version) {
  JsonFields fields(where);
  const Json json = fields.parsed(text);
  MapDescription description;
  description.version = version;
  const Json& parameters = fields.object(json, "layer_parameters");
  for (const Json& layer : fields.array(json, "layers")) {
    if (!layer.is_string() || !is_layer_name(layer.get_ref<const std::string&>())) {
      fields.fail("\"layers\" has a member that is not a layer name");
      break;
    }
    const std::string name = layer.get<std::string>();
    description.layers.insert_or_assign(
        name, layer_parameters_from_json(fields.object(parameters, name.c_str())));
  }
  description.feature = feature_parameters_from_json(fields.object(json, "feature"));
  description.bounds = bounds_of(fields, fields.object(json, "bounds"));
  if (json.contains("datum")) {
    Result<Datum> datum = Datum::from(fields.text(json, "datum"));
    if (!datum) fields.fail("\"datum\" " + datum.error().what);
    if (datum) description.datum = std::move(*datum);
  }
  if (!fields.ok()) return fields.error();
  return description;
}

Result<SegmentDocument> parse_segment_document(std::string_view text, const std::string& where,
                                               const MapVersion& version,
                                               const std::string& segment) {
  JsonFields fields(where);
  const Json json = fields.parsed(text);
  check_is_about(fields, segment, fields.text(json, "segment"));
  SegmentDocument document;
  document.description.id = segment;
  document.description.length_m = fields.number(json, "length_m", 0, kMaxAlongM);
  for (const Json& point : fields.array(json, "line")) {
    document.description.vertices.push_back(vertex_of(fields, point));
  }
  document.description.successors = successors_of(fields, json, version.map);
  document.description.passes = passes_of(fields, json);
  document.description.position_error = position_error_of(fields, json);
  document.tiles = indices_of(fields, json, "tiles", tile_entry_of, &TileEntry::index);
  if (!fields.ok()) return fields.error();
  return document;
}

Result<AreasDocument> parse_areas_document(std::string_view text, const std::string& where) {
  JsonFields fields(where);
  const Json json = fields.parsed(text);
  AreasDocument document = indices_of(fields, json, "cells", cell_entry_of, &CellEntry::cell);
  if (!fields.ok()) return fields.error();
  return document;
}

std::vector<TileEntry> entries_meeting(const std::vector<TileEntry>& index,
                                       const AlongRange& range) {
  std::vector<TileEntry> meeting;
  for (const TileEntry& entry : index) {
    if (entry.along.meets(range)) meeting.push_back(entry);
  }
  return meeting;
}

std::vector<CellEntry> entries_meeting(const std::vector<CellEntry>& index, const Bounds& box) {
  std::vector<CellEntry> meeting;
  for (const CellEntry& entry : index) {
    if (GridCell::numbered(entry.cell).bounds().meets(box)) meeting.push_back(entry);
  }
  return meeting;
}

std::uint64_t bytes_of(const std::vector<TileEntry>& index) {
  std::uint64_t bytes = 0;
  for (const TileEntry& entry : index) bytes += entry.bytes;
  return bytes;
}

}  // namespace milepost
