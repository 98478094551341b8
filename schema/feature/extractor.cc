#include "schema/feature/extractor.h"

#include <algorithm>
#include <cstring>

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

namespace milepost {
namespace {

constexpr double kBrightPart = 0.99;      // quantile of the grey values: a frame's brightness
constexpr double kBright = 150;           // brightness of frames in ordinary light
constexpr double kLeastBrightness = 0.2;  // of kBright; darker frames are mostly noise

// SIFT of OpenCV finds its keypoints on an enlarged image, whose pixels' centres lie a quarter of a
// pixel beside those that it scales them back to.
constexpr float kEnlargedShiftPx = 0.25F;

// Brightness of a frame relative to kBright: [kLeastBrightness, 1].
double brightness_of(const cv::Mat& gray) {
  constexpr int kBins = 256;
  constexpr int kChannel = 0;
  constexpr float kRange[] = {0, kBins};
  const float* ranges = kRange;
  cv::Mat histogram;
  cv::calcHist(&gray, 1, &kChannel, cv::noArray(), histogram, 1, &kBins, &ranges);
  const double wanted = kBrightPart * static_cast<double>(gray.total());
  double pixels = 0;
  int bright = 0;
  for (; bright < kBins - 1; ++bright) {
    pixels += histogram.at<float>(bright);
    if (pixels >= wanted) break;
  }
  return std::clamp(bright / kBright, kLeastBrightness, 1.0);
}

}  // namespace

struct FeatureExtractor::Impl {
  FeatureParameters parameters;
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
};

FeatureExtractor::FeatureExtractor(const FeatureParameters& parameters)
    : impl_(std::make_unique<Impl>()) {
  impl_->parameters = parameters;
}

FeatureExtractor::~FeatureExtractor() = default;
FeatureExtractor::FeatureExtractor(FeatureExtractor&&) noexcept = default;
FeatureExtractor& FeatureExtractor::operator=(FeatureExtractor&&) noexcept = default;

FeatureSet FeatureExtractor::extract(const cv::Mat& gray) {
  // In low light all contrasts are small; the descriptors, which have length 1, are unaffected.
  const FeatureParameters& parameters = impl_->parameters;
  const auto sift = cv::SIFT::create(parameters.max_features, parameters.octave_layers,
                                     parameters.contrast_threshold * brightness_of(gray),
                                     parameters.edge_threshold, parameters.sigma, CV_8U);
  sift->detectAndCompute(gray, cv::noArray(), impl_->keypoints, impl_->descriptors);
  FeatureSet set;
  set.features.reserve(impl_->keypoints.size());
  set.descriptors.resize(impl_->keypoints.size());
  for (std::size_t i = 0; i < impl_->keypoints.size(); ++i) {
    const cv::KeyPoint& keypoint = impl_->keypoints[i];
    set.features.push_back(
        {keypoint.pt.x - kEnlargedShiftPx, keypoint.pt.y - kEnlargedShiftPx, keypoint.size});
    std::memcpy(set.descriptors[i].data(), impl_->descriptors.ptr(static_cast<int>(i)),
                kDescriptorBytes);
  }
  return set;
}

}  // namespace milepost
