#include "mapper/pipeline/landmark_layer_builder.h"

#include <algorithm>
#include <cmath>

#include "mapper/tracklets/on_segment.h"
#include "schema/tile/codec.h"

namespace milepost {
namespace {

constexpr double kReachM = 320;  // limit of a tile's centimetre coordinates, with a margin

bool within_reach(const EnuPoint& point) {
  return std::abs(point.east_m) < kReachM && std::abs(point.north_m) < kReachM &&
         std::abs(point.up_m) < kReachM;
}

}  // namespace

LandmarkLayerBuilder::LandmarkLayerBuilder(const StretchContext& context,
                                           const LandmarkLayerSettings& settings)
    : context_(context), settings_(settings), mapper_(context.camera, settings.landmarks) {
  for (const SegmentCut& cut : context.segments) {
    segments_.push_back({&cut, LandmarkSelector(settings.selection),
                         TileAssembler<MappedLandmark>(context.tile_length_m)});
  }
}

void LandmarkLayerBuilder::add_frame(const Frame& recorded, const ExtractedFrame& /*frame*/,
                                     double along_m) {
  mapper_.add_frame(recorded, along_m);
}

void LandmarkLayerBuilder::add_tracks(const std::vector<Track>& tracks) {
  mapper_.add_tracks(tracks);
}

Result<std::vector<BuiltTile>> LandmarkLayerBuilder::take_complete(double along_m) {
  for (const MappedLandmark& landmark : mapper_.take_mapped(std::isinf(along_m))) {
    for (Segment& segment : segments_) {
      if (const auto placed = landmark_on(landmark, segment.cut->on_stretch))
        segment.assembler.add(*placed);
    }
  }
  std::vector<BuiltTile> tiles;
  const double complete_until_m = std::min(along_m, mapper_.oldest_waiting_along_m());
  for (Segment& segment : segments_) {
    const double complete_m = complete_on(complete_until_m, segment.cut->on_stretch);
    for (const auto& complete : segment.assembler.take_complete(complete_m)) {
      Result<BuiltTile> tile = stored(segment, complete.index, complete.items);
      if (!tile) return tile.error();
      if (tile->items > 0) tiles.push_back(std::move(*tile));
    }
  }
  return tiles;
}

// The tile of the best-ranked landmarks that fits the size target of its stretch of road.
Result<BuiltTile> LandmarkLayerBuilder::stored(Segment& segment, std::uint32_t index,
                                               const std::vector<MappedLandmark>& landmarks) const {
  const RouteLine& line = segment.cut->line;
  const double begin_m = index * context_.tile_length_m;
  const double stretch_m = std::min(context_.tile_length_m, line.length_m() - begin_m);
  const double budget = settings_.size_target_kb_per_m * 1000 * stretch_m;
  const std::vector<std::size_t> ranked = segment.selector.ranked(landmarks, line);

  // The largest number of ranked landmarks that fits.
  BuiltTile best{segment.cut->id, index, {}, 0, {}};
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
    const LandmarkTile tile = packed(*segment.cut, index, taken);
    Bytes frame = encode_landmarks(tile);
    if (static_cast<double>(frame.size()) > budget) {
      too_many = count;
      continue;
    }
    fits = count;
    if (tile.landmarks.empty()) continue;  // none in range
    best = {segment.cut->id, index, tile.along(), tile.landmarks.size(), std::move(frame)};
    best_chosen = std::move(chosen);
  }
  for (const std::size_t i : best_chosen) segment.selector.choose(landmarks[i], line);
  if (best.items == 0) return best;
  const Result<LandmarkTile> read = decode_landmarks(best.frame);
  if (!read) {
    return Error{ErrorCode::invalid_input, read.error().where, read.error().what,
                 "lower --tile-length-m or --max-features"};
  }
  best.along = read->along();  // as quantized
  return best;
}

LandmarkTile LandmarkLayerBuilder::packed(const SegmentCut& segment, std::uint32_t index,
                                          const std::vector<MappedLandmark>& landmarks) const {
  LandmarkTile tile{segment.id, index, index * context_.tile_length_m, {}};
  const LocalFrame local(segment.line.point_at(tile.origin_m));
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
