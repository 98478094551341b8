#include "client/evaluate/baselines/along_filter.h"

namespace milepost {
namespace {

class KalmanFilter : public AlongFilter {
 public:
  std::unique_ptr<AlongFilter> clone() const override {
    return std::make_unique<KalmanFilter>(*this);
  }

  void reset(const AlongBelief& belief) override { belief_ = belief; }

  void predict(double step_m, double sigma_w_m) override {
    belief_ = milepost::predict(belief_, step_m, sigma_w_m);
  }

  void update(const Measurement& measurement, double variance_weight) override {
    belief_ = milepost::update(belief_, measurement, variance_weight);
  }

  AlongBelief belief() const override { return belief_; }

 private:
  AlongBelief belief_;
};

}  // namespace

std::unique_ptr<AlongFilter> make_kalman_filter() { return std::make_unique<KalmanFilter>(); }

}  // namespace milepost
