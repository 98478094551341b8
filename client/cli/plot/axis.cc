#include "client/cli/plot/axis.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace milepost::plot {
namespace {

constexpr double kTickTolerance = 1e-9;  // of a step; keeps 0.3 from missing the tick 3 * 0.1

double round_step(double at_least) {
  const double power = std::pow(10.0, std::floor(std::log10(at_least)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= at_least * (1 - kTickTolerance)) return digit * power;
  }
  return 10 * power;
}

std::pair<double, double> drawable(double from, double to) {
  if (!std::isfinite(from) || !std::isfinite(to) || !std::isfinite(to - from)) return {0, 1};
  // Less length than a double resolves would leave no room for ticks.
  const double least = 1e-9 * std::max({1.0, std::abs(from), std::abs(to)});
  if (to - from > least) return {from, to};
  const double half = std::max(0.5, 1e3 * least);
  return {from - half, from + half};
}

}  // namespace

Ticks round_ticks(double from, double to, int most) {
  Ticks ticks;
  ticks.step = round_step((to - from) / most);
  ticks.decimals =
      std::max(0, static_cast<int>(-std::floor(std::log10(ticks.step) + kTickTolerance)));
  const auto first = std::llround(std::ceil(from / ticks.step - kTickTolerance));
  const auto last = std::llround(std::floor(to / ticks.step + kTickTolerance));
  for (auto k = first; k <= last; ++k) {
    ticks.values.push_back(static_cast<double>(k) * ticks.step);
  }
  return ticks;
}

Axis Axis::spanning(std::string label, double from, double to, int most_ticks) {
  const auto [start, end] = drawable(from, to);
  return {std::move(label), start, end, round_ticks(start, end, most_ticks)};
}

Axis Axis::rounded(std::string label, double from, double to, int most_ticks) {
  const auto [start, end] = drawable(from, to);
  const double step = round_ticks(start, end, most_ticks).step;
  const double low = std::floor(start / step + kTickTolerance) * step;
  const double high = std::ceil(end / step - kTickTolerance) * step;
  return {std::move(label), low, high, round_ticks(low, high, most_ticks + 2)};
}

}  // namespace milepost::plot
