#include "mapper/pipeline/layer_builder.h"

#include "mapper/pipeline/landmark_layer_builder.h"
#include "mapper/tracklets/tile_assembler.h"
#include "schema/tile/codec.h"

namespace milepost {
namespace {

// Encodes the tiles that an assembler completes. `encode` encodes a tile's index and items, and
// `decode` verifies the result: nothing is written that a reader would reject.
template <class Item, class Encode, class Decode>
Result<std::vector<StoredTile>> stored(TileAssembler<Item>& assembler, double along_m,
                                       const Encode& encode, const Decode& decode) {
  std::vector<StoredTile> tiles;
  for (auto& complete : assembler.take_complete(along_m)) {
    const std::uint64_t items = complete.items.size();
    Bytes frame = encode(complete.index, std::move(complete.items));
    const auto read = decode(frame);
    if (!read) {
      return Error{ErrorCode::invalid_input, read.error().where, read.error().what,
                   "lower --tile-length-m or --max-features"};
    }
    tiles.push_back({complete.index, complete.along, items, std::move(frame)});
  }
  return tiles;
}

class TrackletLayerBuilder : public LayerBuilder {
 public:
  TrackletLayerBuilder(const RegressionSettings& regression, std::string segment,
                       double tile_length_m)
      : regression_(regression), segment_(std::move(segment)), assembler_(tile_length_m) {}

  void add_tracks(const std::vector<Track>& tracks) override {
    for (const Track& track : tracks) {
      if (const auto tracklet = tracklet_from_track(track, regression_)) assembler_.add(*tracklet);
    }
  }

  Result<std::vector<StoredTile>> take_complete(double along_m) override {
    const auto encode = [this](std::uint32_t index, std::vector<Tracklet> tracklets) {
      return encode_tile({segment_, index, regression_.model, std::move(tracklets)});
    };
    return stored(assembler_, along_m, encode, decode_tile);
  }

 private:
  RegressionSettings regression_;
  std::string segment_;
  TileAssembler<Tracklet> assembler_;
};

class ObservationLayerBuilder : public LayerBuilder {
 public:
  ObservationLayerBuilder(const RegressionSettings& regression, std::string segment,
                          double tile_length_m)
      : regression_(regression), segment_(std::move(segment)), assembler_(tile_length_m) {}

  void add_tracks(const std::vector<Track>& tracks) override {
    for (const Track& track : tracks) {
      if (const auto tracklet = tracklet_from_track(track, regression_)) {
        assembler_.add({*tracklet, track});
      }
    }
  }

  Result<std::vector<StoredTile>> take_complete(double along_m) override {
    const auto encode = [this](std::uint32_t index, std::vector<ObservedTracklet> tracklets) {
      return encode_observations({segment_, index, regression_.model, std::move(tracklets)});
    };
    return stored(assembler_, along_m, encode, decode_observations);
  }

 private:
  RegressionSettings regression_;
  std::string segment_;
  TileAssembler<ObservedTracklet> assembler_;
};

class FrameLayerBuilder : public LayerBuilder {
 public:
  FrameLayerBuilder(const FrameParts& parts, std::string segment, double tile_length_m)
      : parts_(parts), segment_(std::move(segment)), assembler_(tile_length_m) {}

  void add_frame(const Frame& /*recorded*/, const ExtractedFrame& frame, double along_m) override {
    DatabaseFrame stored{along_m, {}, std::nullopt};
    if (parts_.features) stored.features = frame.features;
    if (parts_.image) stored.image = frame.image;
    assembler_.add(std::move(stored));
  }

  Result<std::vector<StoredTile>> take_complete(double along_m) override {
    const auto encode = [this](std::uint32_t index, std::vector<DatabaseFrame> frames) {
      return encode_frames({segment_, index, std::move(frames)});
    };
    return stored(assembler_, along_m, encode, decode_frames);
  }

 private:
  FrameParts parts_;
  std::string segment_;
  TileAssembler<DatabaseFrame> assembler_;
};

}  // namespace

std::unique_ptr<LayerBuilder> make_layer_builder(const Layer& layer,
                                                 const SegmentContext& context) {
  const std::string& segment = context.segment;
  const double tile_length_m = context.tile_length_m;
  switch (layer.items) {
    case LayerItems::landmarks:
      return std::make_unique<LandmarkLayerBuilder>(context, layer.landmarks);
    case LayerItems::observations:
      return std::make_unique<ObservationLayerBuilder>(layer.regression, segment, tile_length_m);
    case LayerItems::frames:
      return std::make_unique<FrameLayerBuilder>(layer.parts, segment, tile_length_m);
    case LayerItems::tracklets:
      break;
  }
  return std::make_unique<TrackletLayerBuilder>(layer.regression, segment, tile_length_m);
}

}  // namespace milepost
