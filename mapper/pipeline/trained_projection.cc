#include "mapper/pipeline/trained_projection.h"

#include <algorithm>

#include "mapper/pipeline/frame_pipeline.h"

namespace milepost {
namespace {

constexpr std::size_t kSampledFrames = 16;  // some thousand descriptors for 128 dimensions

}  // namespace

Result<PcaProjection> trained_projection(const std::vector<Drive>& drives,
                                         const std::vector<StretchPlan>& plans,
                                         const BuildSettings& settings, int jobs) {
  std::size_t total = 0;
  for (const StretchPlan& plan : plans) total += plan.frame_indices.size();
  const std::size_t every = std::max<std::size_t>(1, total / kSampledFrames);

  std::vector<Descriptor> descriptors;
  std::size_t passed = 0;
  for (std::size_t d = 0; d < drives.size(); ++d) {
    std::vector<std::size_t> sampled;
    for (const std::size_t frame : plans[d].frame_indices) {
      if (passed++ % every == 0) sampled.push_back(frame);
    }
    FramePipeline frames(drives[d], sampled, settings.feature, false, jobs);
    for (std::size_t i = 0; i < sampled.size(); ++i) {
      const Result<ExtractedFrame> frame = frames.next();
      if (!frame) return frame.error();
      const auto& of_frame = frame->features.descriptors;
      descriptors.insert(descriptors.end(), of_frame.begin(), of_frame.end());
    }
  }
  return PcaProjection::trained(descriptors, settings.quantization_step);
}

}  // namespace milepost
