// Landmarks of a made-up road as several drives map them.
#pragma once

#include <random>
#include <vector>

#include "mapper/fusion/pass_landmark.h"
#include "tests/mapper/made_up_street.h"

namespace milepost::testing {

// Like those of real features: few of its values are large.
inline Descriptor sparse_descriptor(std::size_t number) {
  Descriptor descriptor = descriptor_of(number);
  for (std::uint8_t& value : descriptor) value = value < 90 ? 0 : value;
  return descriptor;
}

// Features beside a road that leads north, seen from 20 m before them on.
class MadeUpLandmarks {
 public:
  explicit MadeUpLandmarks(std::size_t count, double length_m = 20, unsigned seed = 1)
      : random_(seed) {
    std::uniform_real_distribution<double> along(0, length_m);
    std::uniform_real_distribution<double> side(-12, 12);
    std::uniform_real_distribution<double> height(0, 6);
    std::uniform_real_distribution<double> size(0.1, 0.6);
    for (std::size_t i = 0; i < count; ++i) {
      StreetPoint& feature = features_.emplace_back();
      feature.enu_m = {side(random_), along(random_), height(random_)};
      feature.size_m = size(random_);
    }
  }

  // All features as a drive maps them whose positions are off by `error_m`. The feature i has the
  // descriptor of `first_descriptor` + i.
  std::vector<PassLandmark> mapped(std::size_t pass, const Eigen::Vector3d& error_m,
                                   double sigma_m = 0.02, std::size_t first_descriptor = 0) {
    std::normal_distribution<double> noise(0, sigma_m);
    std::vector<PassLandmark> landmarks;
    for (std::size_t i = 0; i < features_.size(); ++i) {
      const StreetPoint& feature = features_[i];
      PassLandmark seen;
      const Eigen::Vector3d off(noise(random_), noise(random_), noise(random_));
      seen.landmark.position = MadeUpStreet::geo_of(feature.enu_m + error_m + off);
      seen.landmark.covariance_m2 = Eigen::Matrix3d::Identity() * sigma_m * sigma_m;
      seen.landmark.descriptor = sparse_descriptor(first_descriptor + i);
      seen.landmark.depth_m = 20;
      seen.landmark.depth_sigma_m = sigma_m;
      seen.landmark.size_m = feature.size_m;
      seen.landmark.along = {feature.enu_m.y(), feature.enu_m.y() + 15};
      seen.landmark.observations = 5;
      seen.pass = pass;
      seen.stretch_m = 100 + feature.enu_m.y();
      landmarks.push_back(seen);
    }
    return landmarks;
  }

  const std::vector<StreetPoint>& features() const { return features_; }

 private:
  std::mt19937 random_;
  std::vector<StreetPoint> features_;
};

}  // namespace milepost::testing
