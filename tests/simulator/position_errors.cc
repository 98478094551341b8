#include "tests/simulator/position_errors.h"

#include <array>
#include <cmath>
#include <numbers>

#include "tests/simulator/paint.h"

namespace milepost::simulator {
namespace {

// A smooth random function of variance 1: a sum of waves. Its values are correlated over about a
// sixth of a wave's length.
class DriftWave {
 public:
  explicit DriftWave(cv::RNG& random) {
    for (Wave& wave : waves_) {
      wave.per_m = 1 / random.uniform(kShortestM, kLongestM);
      wave.phase = random.uniform(0.0, 2 * std::numbers::pi);
    }
  }

  double at(double along_m) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += std::sin(along_m * wave.per_m + wave.phase);
    return sum * std::sqrt(2.0 / kWaves);
  }

 private:
  static constexpr int kWaves = 8;
  static constexpr double kShortestM = 100;  // of a wave's length, divided by 2 pi
  static constexpr double kLongestM = 300;

  struct Wave {
    double per_m = 0, phase = 0;
  };
  std::array<Wave, kWaves> waves_;
};

}  // namespace

std::vector<PoseError> draw_errors(const PositionErrors& sizes, const std::vector<double>& alongs_m,
                                   std::uint64_t seed) {
  cv::RNG random = seeded(seed * 0x51ed27 + 9);
  Point bias;
  for (int axis = 0; axis < 3; ++axis) bias[axis] = random.gaussian(1);
  const std::array<DriftWave, 3> drift = {DriftWave(random), DriftWave(random), DriftWave(random)};
  std::vector<PoseError> errors;
  for (const double along_m : alongs_m) {
    PoseError error;
    for (int axis = 0; axis < 3; ++axis) {
      error.position[axis] = bias[axis] * sizes.bias_m + drift[axis].at(along_m) * sizes.drift_m +
                             random.gaussian(1) * sizes.noise_m;
    }
    error.heading_deg = random.gaussian(1) * sizes.heading_deg;
    errors.push_back(error);
  }
  return errors;
}

}  // namespace milepost::simulator
