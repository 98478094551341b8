#include "server/routes/lookup.h"

#include <algorithm>
#include <charconv>

#include "schema/base/digest.h"
#include "schema/base/ids.h"

namespace milepost::server {
namespace {

Status check_id(const std::string& kind, const std::string& id) {
  if (is_segment_id(id)) return ok_status();
  return Error{ErrorCode::invalid_input, kind + " '" + id + "'", "is not a valid name",
               "write 1 to 64 of A-Z a-z 0-9 . _ -, not starting with a dot"};
}

Status check_build(const std::string& build) {
  if (is_digest(build)) return ok_status();
  return Error{ErrorCode::invalid_input, "build '" + build + "'", "is not a valid build",
               "write 32 lower-case hexadecimal digits, as /v1/maps does"};
}

Error absent(const std::string& what, const std::string& hint) {
  return {ErrorCode::not_found, what, "does not exist", hint};
}

Error no_map(const std::string& name) {
  return absent("map '" + name + "'", "/v1/maps lists the maps");
}

// The index of a layer.
template <class Entry>
Result<const std::vector<Entry>*> find_index(
    const std::map<std::string, std::vector<Entry>>& layers, const std::string& layer) {
  const Status form = check_id("layer", layer);
  if (!form) return form.error();
  const auto found = layers.find(layer);
  if (found == layers.end()) {
    return absent("layer '" + layer + "'", "the map's document lists its layers");
  }
  return &found->second;
}

// The entry with the number `text` in an index that ascends by `number_of`.
template <class Entry>
Result<const Entry*> find_entry(const std::string& kind, const std::vector<Entry>& index,
                                std::uint32_t Entry::*number_of, const std::string& text,
                                const std::string& hint) {
  std::uint32_t number = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  // Each tile has exactly one URL, so "07" is invalid.
  if (error != std::errc() || stop != end || (text.size() > 1 && text.front() == '0')) {
    return Error{ErrorCode::invalid_input, kind + " '" + text + "'", "is not a valid number",
                 "write a whole number without leading zeros"};
  }
  const auto found = std::ranges::lower_bound(index, number, {}, number_of);
  if (found == index.end() || (*found).*number_of != number) return absent(kind + " " + text, hint);
  return &*found;
}

}  // namespace

Result<std::shared_ptr<const ServedMap>> find_map(const Catalog& catalog, const std::string& name) {
  const Status form = check_id("map", name);
  if (!form) return form.error();
  const auto found = catalog.maps().find(name);
  if (found == catalog.maps().end()) return no_map(name);
  return catalog.read(*found->second);
}

Result<std::shared_ptr<const ServedMap>> find_build(const Catalog& catalog, const std::string& name,
                                                    const std::string& build) {
  const Status form = check_id("map", name);
  if (!form) return form.error();
  const auto current = catalog.maps().find(name);
  const bool is_there = current != catalog.maps().end();
  if (!is_there && !catalog.old_builds().contains(name)) return no_map(name);
  if (const Status digest = check_build(build); !digest) return digest.error();
  const std::shared_ptr<const MapBuild> found = catalog.build(name, build);
  if (found) return catalog.read(*found);
  if (!is_there) return no_map(name);
  return Error{ErrorCode::gone, "build " + build, "is not the map's current one",
               "use build " + current->second->build};
}

Result<std::shared_ptr<const ServedMap>> find_kept_build(const Catalog& catalog,
                                                         const std::string& name,
                                                         const std::string& build) {
  if (const Status form = check_id("map", name); !form) return form.error();
  if (const Status digest = check_build(build); !digest) return digest.error();
  if (const auto found = catalog.build(name, build)) return catalog.read(*found);
  if (const auto older = catalog.older_build(name, build)) return catalog.read(*older);
  return Error{ErrorCode::gone, "build " + build, "is not kept any more",
               "fetch the build that /v1/maps/" + name + " names"};
}

Result<const ServedSegment*> find_segment(const ServedMap& map, const std::string& id) {
  const Status form = check_id("segment", id);
  if (!form) return form.error();
  const auto found = map.segments().find(id);
  if (found == map.segments().end()) {
    return absent("segment '" + id + "'", "/v1/maps/" + map.name() + " lists the segments");
  }
  return &found->second;
}

Result<const std::vector<TileEntry>*> find_layer(const ServedSegment& segment,
                                                 const std::string& layer) {
  return find_index(segment.tiles, layer);
}

Result<const TileEntry*> find_tile(const std::vector<TileEntry>& tiles, const std::string& index) {
  return find_entry("tile", tiles, &TileEntry::index, index,
                    "the segment's document lists its tiles");
}

Result<const std::vector<CellEntry>*> find_cells(const ServedMap& map, const std::string& layer) {
  return find_index(map.cells(), layer);
}

Result<const CellEntry*> find_cell(const std::vector<CellEntry>& cells, const std::string& number) {
  return find_entry("cell", cells, &CellEntry::cell, number, ".../areas lists the cells");
}

}  // namespace milepost::server
