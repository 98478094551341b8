#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "client/estimation/resampling.h"
#include "client/evaluate/baselines/along_filter.h"

namespace milepost {
namespace {

class ParticleFilter : public AlongFilter {
 public:
  ParticleFilter(std::size_t particles, std::uint64_t seed)
      : random_(seed), along_m_(particles), weights_(particles) {}

  std::unique_ptr<AlongFilter> clone() const override {
    return std::make_unique<ParticleFilter>(*this);
  }

  void reset(const AlongBelief& belief) override {
    std::normal_distribution<double> prior(belief.along_m, std::sqrt(belief.variance_m2));
    for (double& along_m : along_m_) along_m = prior(random_);
    belief_ = belief;
  }

  void predict(double step_m, double sigma_w_m) override {
    std::normal_distribution<double> transition(step_m, sigma_w_m);
    for (double& along_m : along_m_) along_m += transition(random_);
    std::fill(weights_.begin(), weights_.end(), 1.0);
    belief_ = weighed_belief();
  }

  void update(const Measurement& measurement, double variance_weight) override {
    weigh(measurement, variance_weight);
    belief_ = weighed_belief();
    resample();
  }

  AlongBelief belief() const override { return belief_; }

 private:
  // Eq. 6 for each particle, relative to the most likely one: far from all particles the density
  // underflows.
  void weigh(const Measurement& measurement, double variance_weight) {
    const double variance_y = variance_weight * measurement.sigma_m * measurement.sigma_m;
    const auto squared_off_m2 = [&](double along_m) {
      return (along_m - measurement.along_m) * (along_m - measurement.along_m);
    };
    double least_m2 = std::numeric_limits<double>::infinity();
    for (const double along_m : along_m_) least_m2 = std::min(least_m2, squared_off_m2(along_m));
    for (std::size_t i = 0; i < along_m_.size(); ++i) {
      weights_[i] = std::exp((least_m2 - squared_off_m2(along_m_[i])) / (2 * variance_y));
    }
  }

  AlongBelief weighed_belief() const {
    double total = 0;
    double mean_m = 0;
    for (std::size_t i = 0; i < along_m_.size(); ++i) {
      total += weights_[i];
      mean_m += weights_[i] * along_m_[i];
    }
    mean_m /= total;
    double variance_m2 = 0;
    for (std::size_t i = 0; i < along_m_.size(); ++i) {
      variance_m2 += weights_[i] * (along_m_[i] - mean_m) * (along_m_[i] - mean_m) / total;
    }
    return {mean_m, variance_m2};
  }

  void resample() {
    const double total = std::accumulate(weights_.begin(), weights_.end(), 0.0);
    std::vector<double> drawn_m;
    drawn_m.reserve(along_m_.size());
    resample_systematically(
        along_m_.size(), [&](std::size_t i) { return weights_[i]; }, total, along_m_.size(),
        random_, [&](std::size_t i) { drawn_m.push_back(along_m_[i]); });
    along_m_ = std::move(drawn_m);
  }

  std::mt19937_64 random_;
  std::vector<double> along_m_;  // of each particle
  std::vector<double> weights_;  // of each, not normalized
  AlongBelief belief_;
};

}  // namespace

std::unique_ptr<AlongFilter> make_particle_filter(std::size_t particles, std::uint64_t seed) {
  return std::make_unique<ParticleFilter>(particles, seed);
}

}  // namespace milepost
