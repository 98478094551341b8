#include "mapper/pipeline/pass_frames.h"

#include <algorithm>

#include "mapper/pipeline/frame_pipeline.h"

namespace milepost {

std::vector<std::size_t> spread_evenly(const std::vector<std::size_t>& frames, std::size_t count) {
  std::vector<std::size_t> some;
  count = std::min(frames.size(), count);
  some.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    some.push_back(frames[(2 * i + 1) * frames.size() / (2 * count)]);
  return some;
}

std::vector<std::size_t> PassFrames::on(const Pass& pass) const {
  const DrivenLine& driven = lines_[pass.drive].lines[pass.stretch];
  const std::vector<double>& along_m = driven.line.along_m();
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i < along_m.size(); ++i) {
    if (along_m[i] >= pass.from_m && along_m[i] <= pass.to_m) frames.push_back(driven.frames[i]);
  }
  if (!frames.empty()) return frames;
  const auto next = std::ranges::lower_bound(along_m, pass.from_m);
  return {driven.frames[std::min<std::size_t>(static_cast<std::size_t>(next - along_m.begin()),
                                              driven.frames.size() - 1)]};
}

std::optional<std::vector<FeatureSet>> PassFrames::features(const Pass& pass,
                                                            const std::vector<std::size_t>& frames,
                                                            const FeatureParameters& parameters) {
  FramePipeline pipeline(drive_of(pass), frames, parameters, false, jobs_);
  std::vector<FeatureSet> features;
  features.reserve(frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    Result<ExtractedFrame> frame = pipeline.next();
    if (!frame) {
      if (!failure_) failure_ = frame.error();
      return std::nullopt;
    }
    features.push_back(std::move(frame->features));
  }
  return features;
}

}  // namespace milepost
