#include "client/fetch/prefetcher.h"

#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace milepost {
namespace {

struct Request {
  MapVersion version;
  std::string segment;
  std::string layer;
  AlongRange range;
};

}  // namespace

struct Prefetcher::Impl {
  explicit Impl(std::shared_ptr<MapSource> given) : source(std::move(given)) {
    thread = std::thread([this] { work(); });
  }

  ~Impl() {
    {
      const std::lock_guard lock(mutex);
      stopping = true;
    }
    changed.notify_all();
    thread.join();
  }

  void work() {
    std::unique_lock lock(mutex);
    for (;;) {
      changed.wait(lock, [this] { return stopping || next.has_value(); });
      if (stopping) return;
      const Request request = *std::exchange(next, std::nullopt);
      busy = true;
      lock.unlock();
      const auto tiles =
          source->tiles(request.version, request.segment, request.layer, request.range);
      lock.lock();
      busy = false;
      if (!tiles.ok()) failure = tiles.error();
      changed.notify_all();
    }
  }

  const std::shared_ptr<MapSource> source;
  mutable std::mutex mutex;  // guards all below but the thread
  std::condition_variable changed;
  std::optional<Request> next;
  bool busy = false;
  bool stopping = false;
  std::optional<Error> failure;  // the latest
  std::thread thread;
};

Prefetcher::Prefetcher(std::shared_ptr<MapSource> source)
    : impl_(std::make_unique<Impl>(std::move(source))) {}

Prefetcher::~Prefetcher() = default;

void Prefetcher::request(const MapVersion& version, const std::string& segment,
                         const std::string& layer, const AlongRange& range) {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->next = Request{version, segment, layer, range};
  }
  impl_->changed.notify_all();
}

void Prefetcher::wait_idle() {
  std::unique_lock lock(impl_->mutex);
  impl_->changed.wait(lock, [this] { return !impl_->next.has_value() && !impl_->busy; });
}

std::optional<Error> Prefetcher::last_error() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->failure;
}

}  // namespace milepost
