#include "mapper/pipeline/pass_choice.h"

#include <algorithm>

namespace milepost {
namespace {

constexpr std::size_t kPassFrames = 4;  // of a pass that are looked at
constexpr double kAboutEqual = 0.95;    // of the features of the richest

}  // namespace

std::size_t PassChoice::best(const std::vector<Pass>& passes) {
  if (passes.size() == 1) return 0;
  return settings_.passes == PassPolicy::replace ? latest(passes) : richest(passes);
}

std::size_t PassChoice::latest(const std::vector<Pass>& passes) const {
  const auto last = std::ranges::max_element(
      passes, {}, [&](const Pass& pass) { return frames_.drive_of(pass).captured; });
  return static_cast<std::size_t>(last - passes.begin());
}

std::size_t PassChoice::richest(const std::vector<Pass>& passes) {
  std::vector<Quality> found;
  found.reserve(passes.size());
  for (const Pass& pass : passes) found.push_back(quality_of(pass));
  const double most = std::ranges::max_element(found, {}, &Quality::features)->features;
  std::size_t best = passes.size();
  for (std::size_t i = 0; i < passes.size(); ++i) {
    if (found[i].features < kAboutEqual * most) continue;
    if (best == passes.size() || found[i].spacing_m < kAboutEqual * found[best].spacing_m) best = i;
  }
  return best;
}

PassChoice::Quality PassChoice::quality_of(const Pass& pass) {
  const std::vector<std::size_t> all = frames_.on(pass);
  FeatureParameters every = settings_.feature;
  every.max_features = 0;  // or good frames would all be equal
  const auto some = frames_.features(pass, spread_evenly(all, kPassFrames), every);
  if (!some) return {};
  double features = 0;
  for (const FeatureSet& frame : *some) features += static_cast<double>(frame.size());
  return {features / static_cast<double>(some->size()),
          (pass.to_m - pass.from_m) / static_cast<double>(all.size())};
}

}  // namespace milepost
