// Decodes frames and extracts their features on several threads; returns them in order.
#pragma once

#include <memory>
#include <vector>

#include "schema/base/result.h"
#include "schema/drive/drive.h"
#include "schema/feature/types.h"

namespace milepost {

struct ExtractedFrame {
  FeatureSet features;
  int darkest = 0;  // of the grey values, 0 to 255
  int brightest = 0;
  ImageDescriptor image{};  // all 0 unless requested
};

// Processes a bounded number of frames ahead of the consumer, so memory does not grow with the
// drive. next() is called from one thread; destruction stops the threads.
class FramePipeline {
 public:
  // The features of `drive.frames[i]` for each i of `frame_indices`, and with `images` the whole
  // images' descriptors, on `threads` >= 1 threads. REQUIRES: `drive` outlives the pipeline.
  FramePipeline(const Drive& drive, std::vector<std::size_t> frame_indices,
                const FeatureParameters& parameters, bool images, int threads);
  ~FramePipeline();
  FramePipeline(const FramePipeline&) = delete;
  FramePipeline& operator=(const FramePipeline&) = delete;

  // The next frame. REQUIRES: called at most once per frame index.
  // Errors: those of FrameReader::gray.
  Result<ExtractedFrame> next();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost
