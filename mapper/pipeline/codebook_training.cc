#include "mapper/pipeline/codebook_training.h"

#include <algorithm>

#include "mapper/pipeline/frame_pipeline.h"

namespace milepost {

Result<PcaProjection> trained_codebook(const std::vector<DrivePlan>& drives,
                                       const BuildSettings& settings, std::size_t frames,
                                       const std::string& version, int jobs) {
  std::size_t total = 0;
  for (const DrivePlan& drive : drives) total += drive.frames();
  const std::size_t every = std::max<std::size_t>(1, total / frames);

  std::vector<Descriptor> descriptors;
  std::size_t passed = 0;
  for (const DrivePlan& drive : drives) {
    std::vector<std::size_t> sampled;
    for (const StretchPlan& stretch : drive.stretches) {
      for (const std::size_t frame : stretch.frame_indices) {
        if (passed++ % every == 0) sampled.push_back(frame);
      }
    }
    FramePipeline pipeline(*drive.drive, sampled, settings.feature, false, jobs);
    for (std::size_t i = 0; i < sampled.size(); ++i) {
      const Result<ExtractedFrame> frame = pipeline.next();
      if (!frame) return frame.error();
      const auto& of_frame = frame->features.descriptors;
      descriptors.insert(descriptors.end(), of_frame.begin(), of_frame.end());
    }
  }
  return PcaProjection::trained(descriptors, settings.quantization_step, version);
}

}  // namespace milepost
