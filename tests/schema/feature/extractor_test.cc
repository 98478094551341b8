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
  return FeatureExtractor(FeatureParameters{.max_features = 0}, {}).extract(gray).size();
}

// Blobs are found where they are, to a fraction of a pixel, large and small.
TEST(FeatureExtractor, PlacesHaveNoBias) {
  for (const double sigma_px : {1.2, 2.0, 5.0, 12.0}) {
    SCOPED_TRACE(sigma_px);
    cv::Point2d off;
    int found = 0;
    for (int i = 0; i < 12; ++i) {
      const cv::Point2d centre(100 + 0.08 * i, 110 - 0.05 * i);
      cv::Mat gray(220, 220, CV_8U);
      gray.forEach<std::uint8_t>([&](std::uint8_t& value, const int* at) {
        const double squared = std::pow(at[1] - centre.x, 2) + std::pow(at[0] - centre.y, 2);
        value = cv::saturate_cast<std::uint8_t>(
            60 + 150 * std::exp(-squared / (2 * sigma_px * sigma_px)));
      });
      for (const Feature& feature : FeatureExtractor({}, {}).extract(gray).features) {
        const cv::Point2d by(feature.x_px - centre.x, feature.y_px - centre.y);
        if (cv::norm(by) > 3) continue;
        off += by;
        ++found;
      }
    }
    ASSERT_GT(found, 10);
    EXPECT_NEAR(off.x / found, 0, 0.05);
    EXPECT_NEAR(off.y / found, 0, 0.05);
  }
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

// The frame is searched as it is, and what was found is undistorted.
TEST(FeatureExtractor, UndistortsPlacesAndScales) {
  const cv::Mat gray = blobs();
  const FeatureParameters parameters{.max_features = 0};
  Camera camera{gray.cols, gray.rows, {150, 150, 200, 150}};
  const FeatureSet distorted = FeatureExtractor(parameters, camera).extract(gray);
  camera.lens = *Lens::make(LensModel::brown_conrady, {-0.25});  // folds at 1.15: 0.77 is shown
  const FeatureSet found = FeatureExtractor(parameters, camera).extract(gray);
  ASSERT_EQ(found.features.size(), found.descriptors.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < distorted.size(); ++i) {
    const Feature& before = distorted.features[i];
    const auto expected = camera.pinhole_from_image({before.x_px, before.y_px});
    if (!expected) continue;
    ASSERT_LT(next, found.size());
    const Feature& after = found.features[next];
    EXPECT_EQ(found.descriptors[next], distorted.descriptors[i]);
    EXPECT_NEAR(after.x_px, expected->pinhole_px.x(), 1e-3);
    EXPECT_NEAR(after.y_px, expected->pinhole_px.y(), 1e-3);
    EXPECT_NEAR(after.magnification, expected->magnification, 1e-5);
    EXPECT_NEAR(after.scale_px, before.scale_px * expected->magnification, 1e-3);
    ++next;
  }
  EXPECT_EQ(next, found.size());
  EXPECT_GT(next, distorted.size() / 4);
  EXPECT_LT(next, distorted.size());  // the corners lie beyond the field of view
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
