// What a tile provider knows: what is wanted, what is held, what is missing, and what to do next.
// No threads, no I/O and no clock: its times are told.
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
  double surroundings_margin_m = 100;  // known beyond what is wanted, so that few ask for it
  std::size_t max_segments = 64;       // of the surroundings whose lines are read: the nearest
  double kept_m = 200;                 // tiles so far beyond what is wanted are held still
  BackoffSettings backoff;
  double slow_s = 2;  // a request that fails after longer speaks of the network, not of a tile
  double away_s = 4;  // the network counts as away when it has failed for so long
};

// A tile that may lie in the cache or the file.
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
  std::vector<TileEntry> tiles;  // side by side in the index
};
using FetchTask = std::variant<AskAround, ReadDocuments, FetchTiles>;

// How a request failed.
struct FetchFailure {
  Error error;
  double retry_after_s = 0;  // that a busy server asked for
  SteadyTime began;
  SteadyTime ended;
};

// Not safe to use from several threads at once.
class ProviderState {
 public:
  explicit ProviderState(const ProviderSettings& settings);

  // Replaces what was wanted; lets go of what is far from it.
  void want(Wants wants);
  const Wants& wanted() const { return wants_; }  // by priority
  // What is held now, the same object until something changes.
  std::shared_ptr<const HeldMap> held() const { return held_; }

  // The next thing to read, or to ask for; nothing where there is none. By priority.
  std::optional<StoredTile> next_stored() const;
  std::optional<FetchTask> next_fetch(SteadyTime now) const;
  // The first time after `now` at which next_fetch() may have another answer by itself.
  std::optional<SteadyTime> next_due(SteadyTime now) const;

  // What became of these. Of tiles that are not wanted any more nothing is kept.
  void take(const AskAround& task, std::vector<NearbySegment> near, SteadyTime now);
  void take(std::shared_ptr<const SegmentLayer> layer);
  void take(const SegmentKey& key, std::uint32_t index, std::shared_ptr<const DecodedTile> tile);
  void is_not_stored(const SegmentKey& key, std::uint32_t index);
  // It cannot be used, wherever it came from.
  void is_unusable(const SegmentKey& key, std::uint32_t index, Error error, SteadyTime now);
  void failed(const FetchTask& task, const FetchFailure& failure);
  void succeeded(const FetchTask& task);

  // Whether all that is wanted is held, or was asked for in vain.
  bool is_settled() const;

 private:
  struct Awaited {
    bool may_be_stored = true;
    bool is_hopeless = false;  // it came as it is meant to be, and cannot be used
    Backoff backoff;
  };
  struct Segment {
    HeldSegment held;
    Backoff documents;
    std::map<std::uint32_t, Awaited> awaited;
    std::size_t longest_run = 1000;  // tiles asked for at once: fewer after that failed
    std::shared_ptr<const HeldSegment> published;  // what is held, unless it changed since
  };

  bool knows_surroundings() const;
  std::vector<SegmentKey> documents_wanted() const;
  bool is_away() const;
  bool is_settled(const Want& want) const;
  std::vector<TileEntry> first_run(const Segment& segment, const AlongRange& range,
                                   SteadyTime now) const;
  void await_what_is_wanted();
  void let_go();
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
  Backoff network_;
  std::optional<SteadyTime> failing_since_;  // the network ...
  SteadyTime failed_at_;                     // ... the last time
  std::map<MapVersion, Error> gone_;         // builds that are no more
  std::shared_ptr<const HeldMap> held_ = std::make_shared<const HeldMap>();
  std::mt19937 random_;
};

}  // namespace milepost
