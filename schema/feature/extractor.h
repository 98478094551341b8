// SIFT features of a grey image (the tracklet paper, section 4.1, and Lowe 2004).
#pragma once

#include <memory>

#include <opencv2/core/mat.hpp>

#include "schema/feature/types.h"
#include "schema/geo/camera.h"

namespace milepost {

// Finds features in frames as they are, and undistorts their places and scales, not the frames:
// a frame resampled has other noise and less of the scene. Features beyond the lens's field of view
// are left out.
//
// Not safe to use from several threads at once: one extractor per thread. The features of an image
// depend on the image, the parameters and the camera only, not on threads.
class FeatureExtractor {
 public:
  FeatureExtractor(const FeatureParameters& parameters, const Camera& camera);
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
