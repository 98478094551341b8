#include "schema/feature/extractor.h"

#include <cstring>

#include <opencv2/features2d.hpp>

namespace milepost {

struct FeatureExtractor::Impl {
  cv::Ptr<cv::SIFT> sift;
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
};

FeatureExtractor::FeatureExtractor(const FeatureParameters& parameters)
    : impl_(std::make_unique<Impl>()) {
  impl_->sift = cv::SIFT::create(parameters.max_features, parameters.octave_layers,
                                 parameters.contrast_threshold, parameters.edge_threshold,
                                 parameters.sigma, CV_8U);
}

FeatureExtractor::~FeatureExtractor() = default;
FeatureExtractor::FeatureExtractor(FeatureExtractor&&) noexcept = default;
FeatureExtractor& FeatureExtractor::operator=(FeatureExtractor&&) noexcept = default;

FeatureSet FeatureExtractor::extract(const cv::Mat& gray) {
  impl_->sift->detectAndCompute(gray, cv::noArray(), impl_->keypoints, impl_->descriptors);
  FeatureSet set;
  set.features.reserve(impl_->keypoints.size());
  set.descriptors.resize(impl_->keypoints.size());
  for (std::size_t i = 0; i < impl_->keypoints.size(); ++i) {
    const cv::KeyPoint& keypoint = impl_->keypoints[i];
    set.features.push_back({keypoint.pt.x, keypoint.pt.y, keypoint.size});
    std::memcpy(set.descriptors[i].data(), impl_->descriptors.ptr(static_cast<int>(i)),
                kDescriptorBytes);
  }
  return set;
}

}  // namespace milepost
