#include "client/fetch/tile_provider.h"

#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

namespace milepost {
namespace {

using std::chrono::steady_clock;

}  // namespace

struct TileProvider::Impl {
  Impl(const std::shared_ptr<MapSource>& given, std::string layer_name,
       const ProviderSettings& settings)
      : layer(std::move(layer_name)),
        source(given->until([this] { return stopping.load(); }, MapSource::Asking::once)),
        state(settings) {
    reader = std::thread([this] { read_stored(); });
    fetcher = std::thread([this] { fetch(); });
  }

  ~Impl() {
    {
      const std::lock_guard lock(mutex);
      stopping = true;
    }
    changed.notify_all();
    reader.join();
    fetcher.join();
  }

  using Lock = std::unique_lock<std::mutex>;

  void read_stored();
  void fetch();
  void run(const FetchTask& task);
  Attempt ask(const AskAround& task);
  Attempt ask(const ReadDocuments& task);
  Attempt ask(const FetchTiles& task);
  Attempt ask(const AskCatalog& task);
  Result<std::shared_ptr<const BuildLayer>> parameters_of(const MapVersion& version);
  void take(const SegmentLayer& of, std::uint32_t index, ByteView encoded);

  const std::string layer;
  std::atomic<bool> stopping = false;
  const std::shared_ptr<MapSource> source;  // whose calls are cancelled by the destructor
  // Used by the fetcher thread only.
  std::map<MapVersion, std::shared_ptr<const BuildLayer>> parameters;

  mutable std::mutex mutex;  // guards `state`; never held over I/O or decoding
  mutable std::condition_variable changed;
  ProviderState state;

  std::thread reader;
  std::thread fetcher;
};

TileProvider::TileProvider(const std::shared_ptr<MapSource>& source, std::string layer,
                           const ProviderSettings& settings)
    : impl_(std::make_unique<Impl>(source, std::move(layer), settings)) {}

TileProvider::~TileProvider() = default;

void TileProvider::want(Wants wants) {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->state.want(std::move(wants));
  }
  impl_->changed.notify_all();
}

std::shared_ptr<const HeldMap> TileProvider::held() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->state.held();
}

Wants TileProvider::wanted() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->state.wanted();
}

bool TileProvider::is_settled() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->state.is_settled();
}

void TileProvider::wait_for_change(const std::shared_ptr<const HeldMap>& before,
                                   SteadyTime deadline) const {
  Impl::Lock lock(impl_->mutex);
  impl_->changed.wait_until(
      lock, deadline, [&] { return impl_->state.held() != before || impl_->state.is_settled(); });
}

void TileProvider::Impl::read_stored() {
  Lock lock(mutex);
  while (!stopping) {
    const auto task = state.next_stored();
    if (!task) {
      changed.wait(lock);
      continue;
    }
    lock.unlock();
    const SegmentKey& key = task->of->key;
    const auto stored = source->stored_tile(key.version, key.segment, layer, task->entry);
    if (stored.ok() && *stored) {
      take(*task->of, task->entry.index, **stored);
      lock.lock();
    } else {
      lock.lock();
      if (stored.ok()) {
        state.is_not_stored(key, task->entry.index);
      } else {
        state.is_unusable(key, task->entry.index, stored.error(), steady_clock::now());
      }
    }
    changed.notify_all();
  }
}

void TileProvider::Impl::fetch() {
  Lock lock(mutex);
  while (!stopping) {
    const SteadyTime now = steady_clock::now();
    if (const auto task = state.next_fetch(now)) {
      lock.unlock();
      run(*task);
      lock.lock();
    } else if (const auto due = state.next_due(now)) {
      changed.wait_until(lock, *due);
    } else {
      changed.wait(lock);
    }
  }
}

void TileProvider::Impl::run(const FetchTask& task) {
  const SteadyTime began = steady_clock::now();
  const Attempt attempt = std::visit([this](const auto& asked) { return ask(asked); }, task);
  {
    const std::lock_guard lock(mutex);
    if (attempt.status.ok()) {
      state.succeeded(task);
    } else {
      state.failed(task,
                   {attempt.status.error(), attempt.retry_after_s, began, steady_clock::now()});
    }
  }
  changed.notify_all();
}

Attempt TileProvider::Impl::ask(const AskAround& task) {
  auto near = source->segments_near(task.asked.position, task.asked.radius_m);
  if (!near) return {near.error()};
  const std::lock_guard lock(mutex);
  state.take(task, std::move(*near), steady_clock::now());
  return {};
}

Attempt TileProvider::Impl::ask(const ReadDocuments& task) {
  const auto of_version = parameters_of(task.key.version);
  if (!of_version) return {of_version.error()};
  auto read = read_segment_layer(*source, task.key, layer, *of_version);
  if (!read) return {read.error()};
  const std::lock_guard lock(mutex);
  state.take(std::move(*read));
  return {};
}

Attempt TileProvider::Impl::ask(const FetchTiles& task) {
  const SegmentKey& key = task.of->key;
  return source->fetch_tiles(key.version, key.segment, layer, task.tiles,
                             [&](const EncodedTile& tile) {
                               take(*task.of, tile.index, tile.bytes);
                               changed.notify_all();
                             });
}

Attempt TileProvider::Impl::ask(const AskCatalog& task) {
  const auto catalog = source->maps();
  if (!catalog) return {catalog.error()};
  const std::lock_guard lock(mutex);
  state.take(task, *catalog, steady_clock::now());
  return {};
}

Result<std::shared_ptr<const BuildLayer>> TileProvider::Impl::parameters_of(
    const MapVersion& version) {
  const auto known = parameters.find(version);
  if (known != parameters.end()) return known->second;
  auto read = read_build_layer(*source, version, layer);
  if (read) parameters[version] = *read;
  return read;
}

// Decodes without holding the lock.
void TileProvider::Impl::take(const SegmentLayer& of, std::uint32_t index, ByteView encoded) {
  Result<DecodedTile> tile = decode_tile_of(of.parameters().items, encoded);
  std::shared_ptr<const DecodedTile> finished;
  if (tile) finished = std::make_shared<const DecodedTile>(std::move(*tile));
  const std::lock_guard lock(mutex);
  if (finished) {
    state.take(of.key, index, std::move(finished));
  } else {
    state.is_unusable(of.key, index, tile.error(), steady_clock::now());
  }
}

}  // namespace milepost
