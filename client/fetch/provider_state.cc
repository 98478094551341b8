#include "client/fetch/provider_state.h"

#include <algorithm>
#include <utility>

#include "client/fetch/documents.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

double seconds_between(SteadyTime begin, SteadyTime end) {
  return std::chrono::duration<double>(end - begin).count();
}

bool covers(const Surroundings& known, const Surroundings& asked) {
  return known.radius_m >= 0 &&
         geodesic_distance_m(known.position, asked.position) + asked.radius_m <= known.radius_m;
}

}  // namespace

ProviderState::ProviderState(const ProviderSettings& settings)
    : settings_(settings), random_(std::random_device{}()) {}

void ProviderState::want(Wants wants) {
  const bool asks_for_more = !std::ranges::includes(wants_.maps, wants.maps);
  if (asks_for_more) catalog_.succeeded();  // which has not failed for this question
  wants_ = std::move(wants);
  std::ranges::stable_sort(wants_.tiles, {}, &Want::priority);
  release_unused();
  await_what_is_wanted();
}

// Creates an entry for each wanted segment and tile that is neither held nor awaited.
void ProviderState::await_what_is_wanted() {
  for (const NearbySegment& near : around_) segments_[{near.version, near.segment}];
  for (const Want& want : wants_.tiles) {
    Segment& segment = segments_[want.segment];
    const auto gone = gone_.find(want.segment.version);
    if (gone != gone_.end()) segment.held.failure = gone->second;
    if (!segment.held.layer) continue;
    for (const TileEntry& entry : entries_meeting(segment.held.layer->index, want.range)) {
      if (!segment.held.tiles.contains(entry.index)) segment.awaited[entry.index];
    }
  }
}

void ProviderState::release_unused() {
  bool changed = false;
  for (auto& entry_of_segment : segments_) {
    const SegmentKey& key = entry_of_segment.first;
    Segment& segment = entry_of_segment.second;
    if (!segment.held.layer) continue;
    const auto is_far = [&](const auto& tile) {
      const auto entry =
          std::ranges::lower_bound(segment.held.layer->index, tile.first, {}, &TileEntry::index);
      return std::ranges::none_of(wants_.tiles, [&](const Want& want) {
        return want.segment == key && entry->along.meets(want.range.widened(settings_.kept_m));
      });
    };
    const std::size_t before = segment.held.tiles.size() + segment.held.missing.size();
    std::erase_if(segment.held.tiles, is_far);
    std::erase_if(segment.awaited, is_far);
    std::erase_if(segment.held.missing,
                  [&](const auto& tile) { return !segment.awaited.contains(tile.first); });
    if (before == segment.held.tiles.size() + segment.held.missing.size()) continue;
    segment.published = nullptr;
    changed = true;
  }
  const auto is_of_use = [&](const SegmentKey& key) {
    const bool wanted =
        std::ranges::any_of(wants_.tiles, [&](const Want& want) { return want.segment == key; });
    return wanted || std::ranges::any_of(around_, [&](const NearbySegment& near) {
             return near.version == key.version && near.segment == key.segment;
           });
  };
  changed |=
      std::erase_if(segments_, [&](const auto& segment) { return !is_of_use(segment.first); }) > 0;
  if (changed) publish();
}

std::optional<StoredTile> ProviderState::next_stored() const {
  for (const Want& want : wants_.tiles) {
    const Segment& segment = segments_.at(want.segment);
    if (!segment.held.layer) continue;
    for (const TileEntry& entry : entries_meeting(segment.held.layer->index, want.range)) {
      const auto awaited = segment.awaited.find(entry.index);
      if (awaited != segment.awaited.end() && awaited->second.may_be_stored) {
        return StoredTile{segment.held.layer, entry};
      }
    }
  }
  return std::nullopt;
}

bool ProviderState::knows_surroundings() const {
  return !wants_.around || covers(known_around_, *wants_.around);
}

bool ProviderState::knows_maps() const {
  return std::ranges::all_of(wants_.maps,
                             [&](const std::string& map) { return current_maps_.contains(map); });
}

std::optional<FetchTask> ProviderState::next_fetch(SteadyTime now) const {
  if (!knows_surroundings() && around_backoff_.is_due(now)) {
    Surroundings asked = *wants_.around;
    asked.radius_m += settings_.surroundings_margin_m;
    return AskAround{asked};
  }
  const auto lacks_documents = [&](const SegmentKey& key) {
    const Segment& segment = segments_.at(key);
    return !segment.held.layer && segment.documents.is_due(now) && !gone_.contains(key.version);
  };
  for (const Want& want : wants_.tiles) {
    if (lacks_documents(want.segment)) return ReadDocuments{want.segment};
  }
  for (const Want& want : wants_.tiles) {
    const Segment& segment = segments_.at(want.segment);
    if (!segment.held.layer || !network_.is_due(now)) continue;
    std::vector<TileEntry> run = first_run(segment, want.range, now);
    if (!run.empty()) return FetchTiles{segment.held.layer, std::move(run)};
  }
  if (!knows_maps() && catalog_.is_due(now)) return AskCatalog{};
  for (const SegmentKey& key : documents_wanted()) {
    if (lacks_documents(key)) return ReadDocuments{key};
  }
  return std::nullopt;
}

// The segments of the surroundings that may be the nearest, by the distances listed when they were
// fetched.
std::vector<SegmentKey> ProviderState::documents_wanted() const {
  if (!wants_.around) return {};
  const double moved_m = geodesic_distance_m(known_around_.position, wants_.around->position);
  std::vector<std::pair<double, SegmentKey>> nearest;
  for (const NearbySegment& near : around_) {
    const double least_m = std::abs(near.distance_m - moved_m);
    if (least_m <= wants_.around->radius_m) {
      nearest.emplace_back(least_m, SegmentKey{near.version, near.segment});
    }
  }
  std::ranges::stable_sort(nearest, {}, &std::pair<double, SegmentKey>::first);
  std::vector<SegmentKey> keys;
  for (auto& [least_m, key] : nearest) {
    if (keys.size() == settings_.max_segments) break;
    keys.push_back(std::move(key));
  }
  return keys;
}

// Adjacent tiles to fetch; none while some may be stored, so that the rest comes in one request.
std::vector<TileEntry> ProviderState::first_run(const Segment& segment, const AlongRange& range,
                                                SteadyTime now) const {
  std::vector<TileEntry> run;
  for (const TileEntry& entry : entries_meeting(segment.held.layer->index, range)) {
    const auto awaited = segment.awaited.find(entry.index);
    if (awaited != segment.awaited.end() && awaited->second.may_be_stored) return {};
    const bool is_due = awaited != segment.awaited.end() && !awaited->second.is_hopeless &&
                        awaited->second.backoff.is_due(now);
    if (is_due) run.push_back(entry);
    if ((!is_due && !run.empty()) || run.size() == segment.longest_run) break;
  }
  return run;
}

std::optional<SteadyTime> ProviderState::next_due(SteadyTime now) const {
  std::optional<SteadyTime> first;
  const auto consider = [&](const Backoff& backoff) {
    if (backoff.failures() == 0 || backoff.due() <= now) return;
    if (!first || backoff.due() < *first) first = backoff.due();
  };
  if (!knows_surroundings()) consider(around_backoff_);
  if (!knows_maps()) consider(catalog_);
  consider(network_);
  for (const auto& [key, segment] : segments_) {
    if (!segment.held.layer) consider(segment.documents);
    for (const auto& [index, awaited] : segment.awaited) consider(awaited.backoff);
  }
  return first;
}

void ProviderState::take(const AskAround& task, std::vector<NearbySegment> near, SteadyTime now) {
  // A source that listed a build that is gone is out of date: it is asked again.
  std::optional<Error> old;
  std::erase_if(near, [&](const NearbySegment& segment) {
    const auto gone = gone_.find(segment.version);
    if (gone != gone_.end()) old = gone->second;
    return gone != gone_.end();
  });
  around_ = std::move(near);
  known_around_ = task.asked;
  around_failure_.reset();
  around_backoff_.succeeded();
  if (old) {
    known_around_.radius_m = -1;
    around_failure_ = old;
    around_backoff_.failed(now, 0, settings_.backoff, random_);
  }
  release_unused();
  await_what_is_wanted();
  publish();
}

// A map that the catalog lacks, or still lists as it was, is looked for again later.
void ProviderState::take(const AskCatalog& /*task*/, const std::vector<MapVersion>& catalog,
                         SteadyTime now) {
  for (const MapVersion& version : catalog) {
    const bool is_wanted = wants_.maps.contains(version.map) && !gone_.contains(version);
    if (is_wanted) current_maps_.insert_or_assign(version.map, version);
  }
  if (knows_maps()) {
    catalog_.succeeded();
  } else {
    catalog_.failed(now, 0, settings_.backoff, random_);
  }
  publish();
}

void ProviderState::take(std::shared_ptr<const SegmentLayer> layer) {
  const auto found = segments_.find(layer->key);
  if (found == segments_.end()) return;
  found->second.held.layer = std::move(layer);
  found->second.held.failure.reset();
  found->second.published = nullptr;
  found->second.documents.succeeded();
  await_what_is_wanted();
  publish();
}

void ProviderState::take(const SegmentKey& key, std::uint32_t index,
                         std::shared_ptr<const DecodedTile> tile) {
  const auto found = segments_.find(key);
  if (found == segments_.end() || found->second.awaited.erase(index) == 0) return;
  found->second.held.tiles[index] = std::move(tile);
  found->second.held.missing.erase(index);
  found->second.published = nullptr;
  publish();
}

void ProviderState::is_not_stored(const SegmentKey& key, std::uint32_t index) {
  const auto found = segments_.find(key);
  if (found == segments_.end()) return;
  const auto awaited = found->second.awaited.find(index);
  if (awaited != found->second.awaited.end()) awaited->second.may_be_stored = false;
}

void ProviderState::is_unusable(const SegmentKey& key, std::uint32_t index, Error error,
                                SteadyTime now) {
  const auto found = segments_.find(key);
  if (found == segments_.end()) return;
  const auto awaited = found->second.awaited.find(index);
  if (awaited == found->second.awaited.end()) return;
  awaited->second.may_be_stored = false;
  awaited->second.is_hopeless = error.code == ErrorCode::corrupt;
  awaited->second.backoff.failed(now, 0, settings_.backoff, random_);
  found->second.held.missing.insert_or_assign(index, std::move(error));
  found->second.published = nullptr;
  publish();
}

void ProviderState::failed(const FetchTask& task, const FetchFailure& failure) {
  if (std::holds_alternative<AskAround>(task)) {
    around_failure_ = failure.error;
    around_backoff_.failed(failure.ended, failure.retry_after_s, settings_.backoff, random_);
    return publish();
  }
  if (std::holds_alternative<AskCatalog>(task)) {
    catalog_.failed(failure.ended, failure.retry_after_s, settings_.backoff, random_);
    return;
  }
  const auto* documents = std::get_if<ReadDocuments>(&task);
  const auto* tiles = std::get_if<FetchTiles>(&task);
  const SegmentKey key = documents ? documents->key : tiles->of->key;
  if (failure.error.code == ErrorCode::gone) return give_up(key.version, failure.error);
  const auto found = segments_.find(key);
  if (found == segments_.end()) return;
  Segment& segment = found->second;
  segment.published = nullptr;
  if (documents) {
    segment.held.failure = failure.error;
    segment.documents.failed(failure.ended, failure.retry_after_s, settings_.backoff, random_);
    return publish();
  }
  for (const TileEntry& entry : tiles->tiles) {
    const auto awaited = segment.awaited.find(entry.index);
    if (awaited == segment.awaited.end()) continue;
    segment.held.missing.insert_or_assign(entry.index, failure.error);
    if (tiles->tiles.size() == 1) {
      awaited->second.backoff.failed(failure.ended, failure.retry_after_s, settings_.backoff,
                                     random_);
    }
  }
  segment.longest_run = std::max<std::size_t>(1, tiles->tiles.size() / 2);
  const bool is_slow = seconds_between(failure.began, failure.ended) > settings_.slow_s;
  if (tiles->tiles.size() > 1 || is_slow) network_failed(failure);
  publish();
}

void ProviderState::network_failed(const FetchFailure& failure) {
  if (!failing_since_) failing_since_ = failure.began;
  failed_at_ = failure.ended;
  network_.failed(failure.ended, failure.retry_after_s, settings_.backoff, random_);
}

void ProviderState::succeeded(const FetchTask& task) {
  const auto* tiles = std::get_if<FetchTiles>(&task);
  if (!tiles) return;  // documents may have come from the cache
  failing_since_.reset();
  network_.succeeded();
  const auto found = segments_.find(tiles->of->key);
  if (found != segments_.end()) {
    found->second.longest_run = std::min<std::size_t>(1000, 2 * tiles->tiles.size());
  }
}

// The build was replaced: discards its segments and requests the surroundings again.
void ProviderState::give_up(const MapVersion& version, const Error& error) {
  gone_.insert_or_assign(version, error);
  for (auto& [key, segment] : segments_) {
    if (key.version != version) continue;
    segment = Segment();
    segment.held.failure = error;
  }
  std::erase_if(around_, [&](const NearbySegment& near) { return near.version == version; });
  std::erase_if(current_maps_, [&](const auto& current) { return current.second == version; });
  known_around_.radius_m = -1;
  publish();
}

// Measured up to the last failure: time without requests does not count.
bool ProviderState::is_away() const {
  return failing_since_ && seconds_between(*failing_since_, failed_at_) > settings_.away_s;
}

bool ProviderState::is_settled(const Want& want) const {
  const Segment& segment = segments_.at(want.segment);
  if (!segment.held.layer) return segment.held.failure.has_value();
  return std::ranges::all_of(entries_meeting(segment.held.layer->index, want.range),
                             [&](const TileEntry& entry) {
                               const auto awaited = segment.awaited.find(entry.index);
                               if (awaited == segment.awaited.end()) return true;
                               if (awaited->second.may_be_stored) return false;
                               return awaited->second.backoff.failures() > 0 || is_away();
                             });
}

bool ProviderState::is_settled() const {
  if (!knows_surroundings() && !around_failure_) return false;
  if (!knows_maps() && catalog_.failures() == 0) return false;
  const auto is_open = [&](const SegmentKey& key) {
    const Segment& segment = segments_.at(key);
    return segment.held.layer || segment.held.failure;
  };
  return std::ranges::all_of(documents_wanted(), is_open) &&
         std::ranges::all_of(wants_.tiles, [&](const Want& want) { return is_settled(want); });
}

// Segments that have not changed are shared with the previous snapshot.
void ProviderState::publish() {
  auto held = std::make_shared<HeldMap>();
  for (auto& [key, segment] : segments_) {
    if (!segment.published) segment.published = std::make_shared<const HeldSegment>(segment.held);
    held->segments[key] = segment.published;
  }
  held->known_around = known_around_;
  held->around = around_;
  held->current_maps = current_maps_;
  held->around_failure = around_failure_;
  held_ = std::move(held);
}

}  // namespace milepost
