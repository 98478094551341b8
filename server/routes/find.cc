#include "server/routes/find.h"

#include <algorithm>
#include <charconv>

#include "schema/base/digest.h"
#include "schema/base/ids.h"

namespace milepost::server {
namespace {

Status check_id(const std::string& kind, const std::string& id) {
  if (is_segment_id(id)) return ok_status();
  return Error{ErrorCode::invalid_input, kind + " '" + id + "'", "is not the form of a name",
               "write 1 to 64 of A-Z a-z 0-9 . _ -, not starting with a dot"};
}

Error absent(const std::string& what, const std::string& mend) {
  return {ErrorCode::not_found, what, "does not exist", mend};
}

}  // namespace

Result<std::shared_ptr<const ServedMap>> find_map(const Catalog& catalog, const std::string& name) {
  const Status form = check_id("map", name);
  if (!form) return form.error();
  const auto found = catalog.maps().find(name);
  if (found == catalog.maps().end()) return absent("map '" + name + "'", "/v1/maps lists the maps");
  return found->second;
}

Result<std::shared_ptr<const ServedMap>> find_build(const Catalog& catalog, const std::string& name,
                                                    const std::string& build) {
  Result<std::shared_ptr<const ServedMap>> map = find_map(catalog, name);
  if (!map) return map;
  if (!is_digest(build)) {
    return Error{ErrorCode::invalid_input, "build '" + build + "'", "is not the form of a build",
                 "write 32 lower-case hexadecimal digits, as /v1/maps does"};
  }
  if (build != (*map)->build()) {
    return Error{ErrorCode::gone, "build " + build, "is not the map's current one",
                 "go on with build " + (*map)->build()};
  }
  return map;
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
  const Status form = check_id("layer", layer);
  if (!form) return form.error();
  const auto found = segment.tiles.find(layer);
  if (found == segment.tiles.end()) {
    return absent("layer '" + layer + "'", "the map's document lists its layers");
  }
  return &found->second;
}

Result<const TileEntry*> find_tile(const std::vector<TileEntry>& tiles, const std::string& index) {
  std::uint32_t number = 0;
  const char* end = index.data() + index.size();
  const auto [stop, error] = std::from_chars(index.data(), end, number);
  // One tile has one address, so "07" is none.
  if (error != std::errc() || stop != end || (index.size() > 1 && index.front() == '0')) {
    return Error{ErrorCode::invalid_input, "tile '" + index + "'", "is not the form of an index",
                 "write a whole number without leading zeros"};
  }
  const auto found = std::lower_bound(
      tiles.begin(), tiles.end(), number,
      [](const TileEntry& tile, std::uint32_t wanted) { return tile.index < wanted; });
  if (found == tiles.end() || found->index != number) {
    return absent("tile " + index, "the segment's document lists its tiles");
  }
  return &*found;
}

}  // namespace milepost::server
