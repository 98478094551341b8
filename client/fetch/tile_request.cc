#include "client/fetch/tile_request.h"

#include <algorithm>
#include <array>

#include "client/fetch/documents.h"

namespace milepost {
namespace {

std::vector<TileEntry> first_run(const std::vector<TileEntry>& index,
                                 const std::set<std::uint32_t>& missing) {
  const auto is_missing = [&](const TileEntry& entry) { return missing.contains(entry.index); };
  const auto begin = std::ranges::find_if(index, is_missing);
  return {begin, std::find_if_not(begin, index.end(), is_missing)};
}

// The shortest range that meets every tile of the run. Tiles overlap: if one position lies in all
// of them, the range is the position at which the fewest other bytes are included.
AlongRange narrowest_range(const std::vector<TileEntry>& index, const std::vector<TileEntry>& run) {
  const double first_end_m = std::ranges::min_element(run, {}, [](const TileEntry& e) {
                               return e.along.to_m;
                             })->along.to_m;
  const double last_begin_m = std::ranges::max_element(run, {}, [](const TileEntry& e) {
                                return e.along.from_m;
                              })->along.from_m;
  if (first_end_m <= last_begin_m) return {first_end_m, last_begin_m};
  const std::array<double, 3> positions_m = {
      last_begin_m, last_begin_m + (first_end_m - last_begin_m) / 2, first_end_m};
  const double best_m = *std::ranges::min_element(positions_m, {}, [&](double along_m) {
    return bytes_of(entries_meeting(index, {along_m, along_m}));
  });
  return {best_m, best_m};
}

}  // namespace

TileRequest request_for_first_run(const std::vector<TileEntry>& index,
                                  const std::set<std::uint32_t>& missing) {
  std::vector<TileEntry> run = first_run(index, missing);
  if (run.size() == 1) return {std::nullopt, std::move(run)};
  const AlongRange range = narrowest_range(index, run);
  return {range, entries_meeting(index, range)};
}

}  // namespace milepost
