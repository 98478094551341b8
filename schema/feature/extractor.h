// SIFT features of a grey image (the tracklet paper, section 4.1, and Lowe 2004).
#pragma once

#include <memory>

#include <opencv2/core/mat.hpp>

#include "schema/feature/types.h"

namespace milepost {

// Not safe to use from several threads at once: one extractor per thread. The features of an image
// depend on the image and the parameters only, not on threads.
class FeatureExtractor {
 public:
  explicit FeatureExtractor(const FeatureParameters& parameters);
  ~FeatureExtractor();
  FeatureExtractor(FeatureExtractor&&) noexcept;
  FeatureExtractor& operator=(FeatureExtractor&&) noexcept;

  // REQUIRES: `gray` is 8-bit with one channel, not empty.
  FeatureSet extract(const cv::Mat& gray);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost
