// Routes to stored tiles: a range of them, or one.
#include <cmath>

#include "server/routes/answers.h"
#include "server/routes/lookup.h"
#include "server/routes/routes.h"

namespace milepost::server {
namespace {

// The range of the query: `from_m` is finite, `to_m` may be "inf", the end of any segment.
Result<AlongRange> range_of(const Query& query) {
  const Result<double> from_m = query.number("from_m");
  if (!from_m) return from_m.error();
  const Result<double> to_m = query.number("to_m");
  if (!to_m) return to_m.error();
  if (!std::isfinite(*from_m)) {
    return Error{ErrorCode::invalid_input, "parameter from_m", "is not finite",
                 "write 0 for the segment's start"};
  }
  if (*from_m > *to_m) {
    return Error{ErrorCode::invalid_input, "parameters from_m and to_m",
                 "from_m is greater than to_m", "swap the two"};
  }
  return AlongRange{*from_m, *to_m};
}

}  // namespace

Result<Response> answer_tile_range(const Call& call) {
  const Result<std::shared_ptr<const ServedMap>> map =
      find_build(call.catalog, call.path[0], call.path[1]);
  if (!map) return map.error();
  const Result<const ServedSegment*> segment = find_segment(**map, call.path[2]);
  if (!segment) return segment.error();
  const Result<std::string> layer = call.query.text("layer");
  if (!layer) return layer.error();
  const Result<AlongRange> range = range_of(call.query);
  if (!range) return range.error();
  const Result<const std::vector<TileEntry>*> index = find_layer(**segment, *layer);
  if (!index) return index.error();

  TileList list{*map, call.path[2], *layer, {}};
  for (const TileEntry& tile : **index) {
    if (tile.along.meets(*range)) list.tiles.push_back(&tile);
  }
  const std::string digest = digest_of_all(list.tiles);
  return immutable_tiles(std::move(list), digest);
}

Result<Response> answer_tile(const Call& call) {
  const Result<std::shared_ptr<const ServedMap>> map =
      find_build(call.catalog, call.path[0], call.path[1]);
  if (!map) return map.error();
  const Result<const ServedSegment*> segment = find_segment(**map, call.path[2]);
  if (!segment) return segment.error();
  const Result<const std::vector<TileEntry>*> index = find_layer(**segment, call.path[3]);
  if (!index) return index.error();
  const Result<const TileEntry*> tile = find_tile(**index, call.path[4]);
  if (!tile) return tile.error();
  return divisible(immutable_tiles({*map, call.path[2], call.path[3], {*tile}}, (*tile)->digest));
}

}  // namespace milepost::server
