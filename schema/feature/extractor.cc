#include "schema/feature/extractor.h"

#include <algorithm>
#include <cstring>
#include <optional>

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

std::optional<Feature> feature_of(const cv::KeyPoint& keypoint, const Camera& camera) {
  const Feature found{keypoint.pt.x - kEnlargedShiftPx, keypoint.pt.y - kEnlargedShiftPx,
                      keypoint.size};
  if (camera.lens.is_pinhole()) return found;
  const auto undistorted = camera.pinhole_from_image({found.x_px, found.y_px});
  if (!undistorted) return std::nullopt;
  const auto magnification = static_cast<float>(undistorted->magnification);
  const Eigen::Vector2f at = undistorted->pinhole_px.cast<float>();
  return Feature{at.x(), at.y(), found.scale_px * magnification, magnification};
}

}  // namespace

struct FeatureExtractor::Impl {
  FeatureParameters parameters;
  Camera camera;
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
};

FeatureExtractor::FeatureExtractor(const FeatureParameters& parameters, const Camera& camera)
    : impl_(std::make_unique<Impl>()) {
  impl_->parameters = parameters;
  impl_->camera = camera;
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
  set.descriptors.reserve(impl_->keypoints.size());
  for (std::size_t i = 0; i < impl_->keypoints.size(); ++i) {
    const std::optional<Feature> feature = feature_of(impl_->keypoints[i], impl_->camera);
    if (!feature) continue;
    set.features.push_back(*feature);
    std::memcpy(set.descriptors.emplace_back().data(), impl_->descriptors.ptr(static_cast<int>(i)),
                kDescriptorBytes);
  }
  return set;
}

}  // namespace milepost
