#include "server/http/deadlines.h"

#include <algorithm>

namespace milepost::server {
namespace {

constexpr std::size_t index_of(Phase phase) { return static_cast<std::size_t>(phase); }

}  // namespace

Deadlines::Deadlines(const ConnectionLimits& limits)
    : limits_{std::chrono::milliseconds::max(), limits.idle,        limits.request, limits.stall,
              limits.lingering_close,           limits.last_request} {}

void Deadlines::enter(Waiting& waiting, Phase phase, Clock::time_point now) {
  waiting.unlink();
  waiting.phase = phase;
  waiting.deadline =
      phase == Phase::disk ? Clock::time_point::max() : now + limits_[index_of(phase)];
  lists_[index_of(phase)].push_back(waiting);
}

Waiting* Deadlines::expired(Clock::time_point now) {
  for (List& list : lists_) {
    if (!list.empty() && list.front().deadline <= now) return &list.front();
  }
  return nullptr;
}

std::optional<Clock::time_point> Deadlines::earliest() const {
  Clock::time_point earliest = Clock::time_point::max();
  for (const List& list : lists_) {
    if (!list.empty()) earliest = std::min(earliest, list.front().deadline);
  }
  if (earliest == Clock::time_point::max()) return std::nullopt;
  return earliest;
}

Waiting* Deadlines::first(Phase phase) {
  List& list = lists_[index_of(phase)];
  return list.empty() ? nullptr : &list.front();
}

bool Deadlines::empty() const {
  return std::ranges::all_of(lists_, [](const List& list) { return list.empty(); });
}

}  // namespace milepost::server
