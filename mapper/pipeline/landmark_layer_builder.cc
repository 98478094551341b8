#include "mapper/pipeline/landmark_layer_builder.h"

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

LandmarkLayerBuilder::LandmarkLayerBuilder(const SegmentContext& context,
                                           const LandmarkLayerSettings& settings)
    : context_(context),
      settings_(settings),
      mapper_(context.camera, settings.landmarks),
      selector_(settings.selection),
      assembler_(context.tile_length_m) {}

void LandmarkLayerBuilder::add_frame(const Frame& recorded, const ExtractedFrame& /*frame*/,
                                     double along_m) {
  mapper_.add_frame(recorded, along_m);
}

void LandmarkLayerBuilder::add_tracks(const std::vector<Track>& tracks) {
  mapper_.add_tracks(tracks);
}

Result<std::vector<StoredTile>> LandmarkLayerBuilder::take_complete(double along_m) {
  for (const MappedLandmark& landmark : mapper_.take_mapped(std::isinf(along_m))) {
    assembler_.add(landmark);
  }
  std::vector<StoredTile> tiles;
  const double complete_until_m = std::min(along_m, mapper_.oldest_waiting_along_m());
  for (const auto& complete : assembler_.take_complete(complete_until_m)) {
    Result<StoredTile> tile = stored(complete.index, complete.items);
    if (!tile) return tile.error();
    if (tile->items > 0) tiles.push_back(std::move(*tile));
  }
  return tiles;
}

// The tile of the best-ranked landmarks that fits the size target of its stretch of road.
Result<StoredTile> LandmarkLayerBuilder::stored(std::uint32_t index,
                                                const std::vector<MappedLandmark>& landmarks) {
  const double begin_m = index * context_.tile_length_m;
  const double stretch_m = std::min(context_.tile_length_m, context_.line.length_m() - begin_m);
  const double budget = settings_.size_target_kb_per_m * 1000 * stretch_m;
  const std::vector<std::size_t> ranked = selector_.ranked(landmarks, context_.line);

  // The largest number of ranked landmarks that fits.
  StoredTile best{index, {}, 0, {}};
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
    best = {index, tile.along(), tile.landmarks.size(), std::move(frame)};
    best_chosen = std::move(chosen);
  }
  for (const std::size_t i : best_chosen) selector_.choose(landmarks[i], context_.line);
  if (best.items == 0) return best;
  const Result<LandmarkTile> read = decode_landmarks(best.frame);
  if (!read) {
    return Error{ErrorCode::invalid_input, read.error().where, read.error().what,
                 "lower --tile-length-m or --max-features"};
  }
  best.along = read->along();  // as quantized
  return best;
}

LandmarkTile LandmarkLayerBuilder::packed(std::uint32_t index,
                                          const std::vector<MappedLandmark>& landmarks) const {
  LandmarkTile tile{context_.segment, index, index * context_.tile_length_m, {}};
  const LocalFrame local(context_.line.point_at(tile.origin_m));
  for (const MappedLandmark& mapped : landmarks) {
    Landmark landmark;
    landmark.position = local.enu_from_geo(mapped.position);
    if (!within_reach(landmark.position)) continue;
    landmark.descriptor = context_.projection.compact(mapped.descriptor);
    landmark.depth_sigma_m = static_cast<float>(mapped.depth_sigma_m);
    landmark.size_m = static_cast<float>(mapped.size_m);
    landmark.size_sigma = static_cast<float>(std::min(mapped.size_sigma, 1.0));
    landmark.along = mapped.along;
    landmark.observations =
        static_cast<std::uint8_t>(std::min<std::size_t>(mapped.observations, 255));
    tile.landmarks.push_back(landmark);
  }
  return tile;
}

}  // namespace milepost
