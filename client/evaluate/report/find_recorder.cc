#include "client/evaluate/report/find_recorder.h"

#include "client/evaluate/find_errors.h"

namespace milepost {
namespace {

constexpr std::size_t kMostParticles = 1500;  // more would overlap
constexpr std::size_t kMostSampled = 64;

FindSnapshot snapshot_of(std::size_t frame, const ParticleSet& particles) {
  FindSnapshot snapshot{frame, {}};
  Random random(frame);
  for (const Particle& particle :
       resampled(particles, std::min(particles.size(), kMostParticles), random)) {
    snapshot.particles.push_back(particle.pose);
  }
  return snapshot;
}

}  // namespace

void FindRecorder::observe(std::size_t frame, GlobalStatus status,
                           const GlobalLocalizer& localizer) {
  if (walls_.empty()) {
    origin_ = localizer.origin();
    walls_ = localizer.walls().walls();
  }
  latest_ = snapshot_of(frame, localizer.particles());
  if (!found_ && is_tracked(status)) found_ = latest_;
  if (!lost_ && status == GlobalStatus::lost) lost_ = latest_;
  if (frame % stride_ == 0) sample(latest_);
}

// Drops every second snapshot when there are too many; the first frame's stays.
void FindRecorder::sample(const FindSnapshot& snapshot) {
  sampled_.emplace(snapshot.frame, snapshot);
  if (sampled_.size() <= kMostSampled) return;
  stride_ *= 2;
  std::erase_if(sampled_, [&](const auto& each) { return each.first % stride_ != 0; });
}

std::vector<FindSnapshot> FindRecorder::chosen(std::size_t most) const {
  std::map<std::size_t, const FindSnapshot*> shown;
  const auto show = [&](const FindSnapshot& snapshot) { shown.emplace(snapshot.frame, &snapshot); };
  const auto show_near = [&](double frame) {
    const auto next = sampled_.lower_bound(static_cast<std::size_t>(frame));
    show(next == sampled_.end() ? latest_ : next->second);
  };
  if (sampled_.empty()) return {};
  show(sampled_.begin()->second);
  show(latest_);
  if (found_) show_near(static_cast<double>(found_->frame) / 2);
  if (found_) show(*found_);
  if (lost_) show(*lost_);
  const double since = found_ ? static_cast<double>(found_->frame) : 0;
  const double length = static_cast<double>(latest_.frame) - since;
  const std::size_t left = most - shown.size();
  for (std::size_t k = 1; k <= left; ++k) {
    show_near(since + length * static_cast<double>(k) / static_cast<double>(left + 1));
  }
  std::vector<FindSnapshot> snapshots;
  snapshots.reserve(shown.size());
  for (const auto& [frame, snapshot] : shown) snapshots.push_back(*snapshot);
  return snapshots;
}

}  // namespace milepost
