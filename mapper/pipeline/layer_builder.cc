#include "mapper/pipeline/layer_builder.h"

#include "mapper/tracklets/on_segment.h"
#include "mapper/tracklets/tile_assembler.h"
#include "schema/tile/codec.h"

namespace milepost {
namespace {

constexpr std::size_t kMinObservations = 3;  // of a tracklet

// The tiles of each segment, as its items become complete.
template <class Item>
class SegmentTiles {
 public:
  explicit SegmentTiles(const StretchContext& context) : segments_(context.segments) {
    for (std::size_t i = 0; i < segments_.size(); ++i)
      assemblers_.emplace_back(context.tile_length_m);
  }

  // Adds what `place(range)` makes of an item on the segment at this range of the stretch: the item
  // in the segment's arc length, or nothing.
  template <class Place>
  void add(const Place& place) {
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      if (auto item = place(segments_[i].on_stretch)) assemblers_[i].add(std::move(*item));
    }
  }

  // Encodes the tiles that are complete. `encode` encodes a segment's id, a tile's index and items,
  // and `decode` verifies the result: nothing is written that a reader would reject.
  template <class Encode, class Decode>
  Result<std::vector<BuiltTile>> take_complete(double along_m, const Encode& encode,
                                               const Decode& decode) {
    std::vector<BuiltTile> tiles;
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      const std::string& segment = segments_[i].id;
      const double complete_m = complete_on(along_m, segments_[i].on_stretch);
      for (auto& complete : assemblers_[i].take_complete(complete_m)) {
        const std::uint64_t items = complete.items.size();
        Bytes frame = encode(segment, complete.index, std::move(complete.items));
        const auto read = decode(frame);
        if (!read) {
          return Error{ErrorCode::invalid_input, read.error().where, read.error().what,
                       "lower --tile-length-m or --max-features"};
        }
        tiles.push_back({segment, complete.index, complete.along, items, std::move(frame)});
      }
    }
    return tiles;
  }

 private:
  const std::vector<SegmentCut>& segments_;
  std::vector<TileAssembler<Item>> assemblers_;
};

class TrackletLayerBuilder : public LayerBuilder {
 public:
  TrackletLayerBuilder(const RegressionSettings& regression, const StretchContext& context)
      : regression_(regression), tiles_(context) {}

  void add_tracks(const std::vector<Track>& tracks) override {
    for (const Track& track : tracks) {
      tiles_.add([&](const AlongRange& segment) -> std::optional<Tracklet> {
        const auto part = track_on(track, segment, kMinObservations);
        return part ? tracklet_from_track(*part, regression_) : std::nullopt;
      });
    }
  }

  Result<std::vector<BuiltTile>> take_complete(double along_m) override {
    const auto encode = [this](const std::string& segment, std::uint32_t index,
                               std::vector<Tracklet> tracklets) {
      return encode_tile({segment, index, regression_.model, std::move(tracklets)});
    };
    return tiles_.take_complete(along_m, encode, decode_tile);
  }

 private:
  RegressionSettings regression_;
  SegmentTiles<Tracklet> tiles_;
};

class ObservationLayerBuilder : public LayerBuilder {
 public:
  ObservationLayerBuilder(const RegressionSettings& regression, const StretchContext& context)
      : regression_(regression), tiles_(context) {}

  void add_tracks(const std::vector<Track>& tracks) override {
    for (const Track& track : tracks) {
      tiles_.add([&](const AlongRange& segment) -> std::optional<ObservedTracklet> {
        const auto part = track_on(track, segment, kMinObservations);
        const auto tracklet = part ? tracklet_from_track(*part, regression_) : std::nullopt;
        if (!tracklet) return std::nullopt;
        return ObservedTracklet{*tracklet, *part};
      });
    }
  }

  Result<std::vector<BuiltTile>> take_complete(double along_m) override {
    const auto encode = [this](const std::string& segment, std::uint32_t index,
                               std::vector<ObservedTracklet> tracklets) {
      return encode_observations({segment, index, regression_.model, std::move(tracklets)});
    };
    return tiles_.take_complete(along_m, encode, decode_observations);
  }

 private:
  RegressionSettings regression_;
  SegmentTiles<ObservedTracklet> tiles_;
};

class FrameLayerBuilder : public LayerBuilder {
 public:
  FrameLayerBuilder(const FrameParts& parts, const StretchContext& context)
      : parts_(parts), tiles_(context) {}

  void add_frame(const Frame& /*recorded*/, const ExtractedFrame& frame, double along_m) override {
    tiles_.add([&](const AlongRange& segment) -> std::optional<DatabaseFrame> {
      if (!segment.contains(along_m)) return std::nullopt;
      DatabaseFrame stored{along_m - segment.from_m, {}, std::nullopt};
      if (parts_.features) stored.features = frame.features;
      if (parts_.image) stored.image = frame.image;
      return stored;
    });
  }

  Result<std::vector<BuiltTile>> take_complete(double along_m) override {
    const auto encode = [](const std::string& segment, std::uint32_t index,
                           std::vector<DatabaseFrame> frames) {
      return encode_frames({segment, index, std::move(frames)});
    };
    return tiles_.take_complete(along_m, encode, decode_frames);
  }

 private:
  FrameParts parts_;
  SegmentTiles<DatabaseFrame> tiles_;
};

}  // namespace

std::unique_ptr<LayerBuilder> make_layer_builder(const Layer& layer,
                                                 const StretchContext& context) {
  switch (layer.items) {
    case LayerItems::observations:
      return std::make_unique<ObservationLayerBuilder>(layer.regression, context);
    case LayerItems::frames:
      return std::make_unique<FrameLayerBuilder>(layer.parts, context);
    case LayerItems::tracklets:
    case LayerItems::landmarks:
      break;
  }
  return std::make_unique<TrackletLayerBuilder>(layer.regression, context);
}

}  // namespace milepost
