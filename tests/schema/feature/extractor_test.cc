#include "schema/feature/extractor.h"

#include <gtest/gtest.h>

#include <cmath>

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

namespace milepost {
namespace {

// Blobs of many sizes and contrasts, the brightest of them white.
cv::Mat blobs() {
  cv::Mat gray(300, 400, CV_8U, cv::Scalar(20));
  cv::RNG random(7);
  for (int i = 0; i < 250; ++i) {
    const cv::Point centre(random.uniform(10, 390), random.uniform(10, 290));
    cv::circle(gray, centre, random.uniform(2, 9), cv::Scalar(random.uniform(40, 256)), cv::FILLED,
               cv::LINE_AA);
  }
  cv::GaussianBlur(gray, gray, {}, 1.0);
  return gray;
}

cv::Mat in_light(const cv::Mat& gray, double part) {
  cv::Mat darker;
  gray.convertTo(darker, CV_8U, part);
  return darker;
}

std::size_t features_of(const cv::Mat& gray) {
  return FeatureExtractor(FeatureParameters{.max_features = 0}).extract(gray).size();
}

TEST(FeatureExtractor, FindsInLittleLightAboutWhatItFindsInMuch) {
  const cv::Mat gray = blobs();
  const auto in_daylight = static_cast<double>(features_of(gray));
  ASSERT_GT(in_daylight, 100);
  EXPECT_GT(static_cast<double>(features_of(in_light(gray, 1.0 / 3))), 0.75 * in_daylight);
}

TEST(FeatureExtractor, InOrdinaryLightItIsSiftAsItComes) {
  const FeatureParameters parameters;
  const auto sift = cv::SIFT::create(0, parameters.octave_layers, parameters.contrast_threshold,
                                     parameters.edge_threshold, parameters.sigma, CV_8U);
  for (const double light : {0.8, 1.0}) {
    const cv::Mat gray = in_light(blobs(), light);
    std::vector<cv::KeyPoint> keypoints;
    sift->detect(gray, keypoints);
    EXPECT_EQ(features_of(gray), keypoints.size()) << light;
  }
}

// Noise of two grey levels in the dark is not texture.
TEST(FeatureExtractor, InTheDarkItDoesNotSeeNoise) {
  cv::Mat dark(300, 400, CV_8U);
  cv::RNG random(3);
  random.fill(dark, cv::RNG::UNIFORM, 3, 5);
  EXPECT_LT(features_of(dark), 20U);
  EXPECT_EQ(features_of(cv::Mat::zeros(300, 400, CV_8U)), 0U);
}

}  // namespace
}  // namespace milepost
