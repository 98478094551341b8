#include "mapper/pipeline/landmark_tile_builder.h"

#include <algorithm>
#include <cmath>

#include "schema/tile/codec.h"

namespace milepost {
namespace {

constexpr double kReachM = 320;  // limit of a tile's centimetre coordinates, with a margin

bool within_reach(const EnuPoint& point) {
  return std::abs(point.east_m) < kReachM && std::abs(point.north_m) < kReachM &&
         std::abs(point.up_m) < kReachM;
}

}  // namespace

// The tile of the best-ranked landmarks that fits the size target of its stretch of road.
Result<BuiltTile> LandmarkTileBuilder::build(std::uint32_t index,
                                             const std::vector<MappedLandmark>& landmarks) {
  const double begin_m = index * tile_length_m_;
  const double stretch_m = std::min(tile_length_m_, line_.length_m() - begin_m);
  const double budget = settings_.size_target_kb_per_m * 1000 * stretch_m;
  const std::vector<std::size_t> ranked = selector_.ranked(landmarks, line_);

  // The largest number of ranked landmarks that fits.
  BuiltTile best{segment_, index, {}, 0, {}};
  std::vector<std::size_t> best_chosen;
  std::size_t fits = 0;
  std::size_t too_many = ranked.size() + 1;
  while (fits + 1 < too_many) {
    const std::size_t count = (fits + too_many) / 2;
    std::vector<std::size_t> chosen(ranked.begin(),
                                    ranked.begin() + static_cast<std::ptrdiff_t>(count));
    std::sort(chosen.begin(), chosen.end());  // back in the order of their begins
    std::vector<MappedLandmark> taken;
    taken.reserve(chosen.size());
    for (const std::size_t i : chosen) taken.push_back(landmarks[i]);
    const LandmarkTile tile = packed(index, taken);
    Bytes frame = encode_landmarks(tile);
    if (static_cast<double>(frame.size()) > budget) {
      too_many = count;
      continue;
    }
    fits = count;
    if (tile.landmarks.empty()) continue;  // none in range
    best = {segment_, index, tile.along(), tile.landmarks.size(), std::move(frame)};
    best_chosen = std::move(chosen);
  }
  for (const std::size_t i : best_chosen) selector_.choose(landmarks[i], line_);
  if (best.items == 0) return best;
  const Result<LandmarkTile> read = decode_landmarks(best.frame);
  if (!read) {
    return Error{ErrorCode::invalid_input, read.error().where, read.error().what,
                 "lower --tile-length-m or --max-features"};
  }
  best.along = read->along();  // as quantized
  best.repeated = static_cast<std::uint64_t>(std::ranges::count_if(
      read->landmarks, [](const Landmark& landmark) { return landmark.passes > 1; }));
  return best;
}

LandmarkTile LandmarkTileBuilder::packed(std::uint32_t index,
                                         const std::vector<MappedLandmark>& landmarks) const {
  LandmarkTile tile{segment_, index, index * tile_length_m_, {}};
  const LocalFrame local(line_.point_at(tile.origin_m));
  for (const MappedLandmark& mapped : landmarks) {
    Landmark landmark;
    landmark.position = local.enu_from_geo(mapped.position);
    if (!within_reach(landmark.position)) continue;
    landmark.descriptor = projection_.compact(mapped.descriptor);
    landmark.depth_sigma_m = static_cast<float>(mapped.depth_sigma_m);
    landmark.size_m = static_cast<float>(mapped.size_m);
    landmark.size_sigma = static_cast<float>(std::min(mapped.size_sigma, 1.0));
    landmark.along = mapped.along;
    landmark.right_m = static_cast<float>(mapped.right_m);
    landmark.observations =
        static_cast<std::uint8_t>(std::min<std::size_t>(mapped.observations, 255));
    landmark.passes = static_cast<std::uint8_t>(std::min<std::size_t>(mapped.passes, 255));
    tile.landmarks.push_back(landmark);
  }
  return tile;
}

}  // namespace milepost
