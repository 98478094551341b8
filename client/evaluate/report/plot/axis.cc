#include "client/evaluate/report/plot/axis.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "client/evaluate/report/plot/text.h"

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

Axis Axis::logarithmic(std::string label, double from, double to) {
  const bool has_logarithms = from > 0 && std::isfinite(to) && from < to;
  const double low = has_logarithms ? from : 0.1;
  const double high = has_logarithms ? to : 10;
  Ticks ticks;
  const auto first = std::lround(std::ceil(std::log10(low) - kTickTolerance));
  const auto last = std::lround(std::floor(std::log10(high) + kTickTolerance));
  for (auto power = first; power <= last; ++power) {
    ticks.values.push_back(std::pow(10.0, static_cast<double>(power)));
  }
  return {std::move(label), low, high, std::move(ticks), Scale::logarithmic};
}

std::string Axis::tick_text(double tick) const {
  if (scale_ == Scale::linear) return number(tick, ticks_.decimals);
  return number(tick, std::max(0, static_cast<int>(std::ceil(-std::log10(tick) - kTickTolerance))));
}

double Axis::share(double value) const {
  if (scale_ == Scale::linear) return (value - from_) / (to_ - from_);
  return std::log(value / from_) / std::log(to_ / from_);
}

}  // namespace milepost::plot
