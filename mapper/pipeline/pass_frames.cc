#include "mapper/pipeline/pass_frames.h"

#include <algorithm>

namespace milepost {

std::vector<std::size_t> frames_on(const Pass& pass, const DrivenLine& driven) {
  std::vector<std::size_t> frames;
  const std::vector<double>& along_m = driven.line.along_m();
  for (std::size_t i = 0; i < along_m.size(); ++i) {
    if (along_m[i] >= pass.from_m && along_m[i] <= pass.to_m) frames.push_back(driven.frames[i]);
  }
  if (!frames.empty()) return frames;
  const auto next = std::ranges::lower_bound(along_m, pass.from_m);
  return {driven.frames[std::min<std::size_t>(static_cast<std::size_t>(next - along_m.begin()),
                                              driven.frames.size() - 1)]};
}

std::vector<std::size_t> spread_evenly(const std::vector<std::size_t>& frames, std::size_t count) {
  std::vector<std::size_t> some;
  count = std::min(frames.size(), count);
  some.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    some.push_back(frames[(2 * i + 1) * frames.size() / (2 * count)]);
  return some;
}

}  // namespace milepost
