#include "server/catalog/reloader.h"

#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string>

namespace milepost::server {
namespace {

using std::chrono::milliseconds;
using Clock = Catalog::Clock;

void log_changes(const Catalog& before, const Catalog& after) {
  auto known = before.maps().begin();
  const auto gone_before = [&](const std::string* name) {
    for (; known != before.maps().end() && (name == nullptr || known->first < *name); ++known)
      spdlog::info("map {}: is no longer served", known->first);
  };
  for (const auto& [name, build] : after.maps()) {  // both in the order of the names
    gone_before(&name);
    if (known == before.maps().end() || known->first != name) {
      spdlog::info("map {}: is served now, build {}", name, build->build);
      continue;
    }
    if (known->second->build != build->build) {
      spdlog::info("map {}: build {} takes the place of {}", name, build->build,
                   known->second->build);
    }
    ++known;
  }
  gone_before(nullptr);
}

}  // namespace

Reloader::Reloader(std::filesystem::path directory, std::shared_ptr<CurrentCatalog> catalog,
                   const ReloadSettings& settings, std::function<void()> also)
    : directory_(std::move(directory)),
      catalog_(std::move(catalog)),
      settings_(settings),
      also_(std::move(also)),
      wake_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  Result<DirectoryWatch> watch = DirectoryWatch::open(directory_);
  if (watch) {
    watch_.emplace(std::move(*watch));
  } else {
    spdlog::warn("{}", watch.error().line());
  }
  thread_ = std::thread([this] { run(); });
}

Reloader::~Reloader() {
  stopping_ = true;
  look();
  thread_.join();
  ::close(wake_);
}

void Reloader::look() {
  const std::uint64_t one = 1;
  static_cast<void>(::write(wake_, &one, sizeof(one)));
}

void Reloader::run() {
  // What happened between the first look at the directory and the watch.
  changes_.may_be_more = true;
  reload();
  while (!stopping_) {
    if (wait(wait_at_most())) settle();
    if (Clock::now() >= look_at_all_) changes_.may_be_more = true;
    if (!stopping_) reload();
  }
}

milliseconds Reloader::wait_at_most() const {
  const auto next = std::min(catalog_->now()->next_change().value_or(look_at_all_), look_at_all_);
  const auto until = std::chrono::ceil<milliseconds>(next - Clock::now());
  return std::clamp(until, milliseconds(1), settings_.interval);
}

// Whether something happened.
bool Reloader::wait(milliseconds at_most) {
  std::array<pollfd, 2> waited = {
      {{wake_, POLLIN, 0}, {watch_ ? watch_->descriptor() : -1, POLLIN, 0}}};
  if (::poll(waited.data(), waited.size(), static_cast<int>(at_most.count())) <= 0) return false;
  std::uint64_t count = 0;
  const bool is_asked = ::read(wake_, &count, sizeof(count)) > 0;
  if (is_asked) changes_.may_be_more = true;
  const bool has_changed = watch_ && watch_->take(changes_);
  return is_asked || has_changed;
}

// Waits until nothing happens any more: files come in several steps.
void Reloader::settle() {
  const auto end = Clock::now() + settings_.patience;
  while (!stopping_ && Clock::now() < end && wait(settings_.quiet)) {
  }
}

void Reloader::reload() {
  also_();
  const std::shared_ptr<const Catalog> before = catalog_->now();
  const DirectoryChanges changes = std::exchange(changes_, {});
  if (changes.may_be_more) look_at_all_ = Clock::now() + settings_.interval;
  const auto after = before->reloaded(
      Clock::now(), [](const std::string& line) { spdlog::warn("{}", line); }, changes);
  if (!after) {
    ++failures_;
    if (!has_failed_) spdlog::error("{}; what was read before is served", after.error().line());
  }
  changes_.may_be_more |= !after;  // nothing of it was taken up
  has_failed_ = !after;
  if (!after || before->is_same(**after)) return;
  ++reloads_;
  catalog_->replace(*after);
  log_changes(*before, **after);
}

}  // namespace milepost::server
