// The state machine of a tile provider: what is wanted, held and missing, and what to fetch next.
// No threads, no I/O and no clock: times are passed in.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "client/fetch/backoff.h"
#include "client/fetch/held_map.h"
#include "client/fetch/wants.h"

namespace milepost {

struct ProviderSettings {
  double surroundings_margin_m = 100;  // requested beyond what is wanted, to save requests
  std::size_t max_segments = 64;       // of the surroundings whose lines are read: the nearest
  double kept_m = 200;                 // tiles up to this distance from what is wanted stay held
  BackoffSettings backoff;
  double slow_s = 2;  // a failure after longer is attributed to the network, not a tile
  double away_s = 4;  // the network counts as unavailable after failing for this long
};

// A tile that may be in the cache or the map file.
struct StoredTile {
  std::shared_ptr<const SegmentLayer> of;
  TileEntry entry;
};

struct AskAround {
  Surroundings asked;
};
struct ReadDocuments {
  SegmentKey key;
};
struct FetchTiles {
  std::shared_ptr<const SegmentLayer> of;
  std::vector<TileEntry> tiles;  // adjacent in the index
};
struct AskCatalog {};
using FetchTask = std::variant<AskAround, ReadDocuments, FetchTiles, AskCatalog>;

// A failed request.
struct FetchFailure {
  Error error;
  double retry_after_s = 0;  // requested by a busy server
  SteadyTime began;
  SteadyTime ended;
};

// Not safe to use from several threads at once.
class ProviderState {
 public:
  explicit ProviderState(const ProviderSettings& settings);

  // Replaces what is wanted; discards what is far from it.
  void want(Wants wants);
  const Wants& wanted() const { return wants_; }  // by priority
  // The current snapshot; the same object until something changes.
  std::shared_ptr<const HeldMap> held() const { return held_; }

  // The next tile to read, or request to send, by priority; none if there is none.
  std::optional<StoredTile> next_stored() const;
  std::optional<FetchTask> next_fetch(SteadyTime now) const;
  // The earliest time after `now` at which next_fetch() may return something else without further
  // events.
  std::optional<SteadyTime> next_due(SteadyTime now) const;

  // The outcomes of these. Results for tiles that are no longer wanted are discarded.
  void take(const AskAround& task, std::vector<NearbySegment> near, SteadyTime now);
  void take(const AskCatalog& task, const std::vector<MapVersion>& catalog, SteadyTime now);
  void take(std::shared_ptr<const SegmentLayer> layer);
  void take(const SegmentKey& key, std::uint32_t index, std::shared_ptr<const DecodedTile> tile);
  void is_not_stored(const SegmentKey& key, std::uint32_t index);
  // The tile cannot be decoded or read, wherever it came from.
  void is_unusable(const SegmentKey& key, std::uint32_t index, Error error, SteadyTime now);
  void failed(const FetchTask& task, const FetchFailure& failure);
  void succeeded(const FetchTask& task);

  // Whether everything wanted is held, or its request has failed.
  bool is_settled() const;

 private:
  struct Awaited {
    bool may_be_stored = true;
    bool is_hopeless = false;  // received as published, but not usable
    Backoff backoff;
  };
  struct Segment {
    HeldSegment held;
    Backoff documents;
    std::map<std::uint32_t, Awaited> awaited;
    std::size_t longest_run = 1000;                // tiles per request: fewer after a failure
    std::shared_ptr<const HeldSegment> published;  // snapshot of `held`; null if it has changed
  };

  bool knows_surroundings() const;
  bool knows_maps() const;
  std::vector<SegmentKey> documents_wanted() const;
  bool is_away() const;
  bool is_settled(const Want& want) const;
  std::vector<TileEntry> first_run(const Segment& segment, const AlongRange& range,
                                   SteadyTime now) const;
  void await_what_is_wanted();
  void release_unused();
  void give_up(const MapVersion& version, const Error& error);
  void network_failed(const FetchFailure& failure);
  void publish();

  ProviderSettings settings_;
  Wants wants_;  // by priority
  std::map<SegmentKey, Segment> segments_;
  Surroundings known_around_{{}, -1};
  std::vector<NearbySegment> around_;
  std::optional<Error> around_failure_;
  Backoff around_backoff_;
  std::map<std::string, MapVersion> current_maps_;  // of those wanted
  Backoff catalog_;
  Backoff network_;
  std::optional<SteadyTime> failing_since_;  // the network, ...
  SteadyTime failed_at_;                     // ... most recently
  std::map<MapVersion, Error> gone_;         // builds that were replaced
  std::shared_ptr<const HeldMap> held_ = std::make_shared<const HeldMap>();
  std::mt19937 random_;
};

}  // namespace milepost
