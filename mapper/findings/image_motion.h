// How a camera moved from image to image, roughly and within milliseconds.
#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "schema/geo/camera.h"

namespace milepost {

struct MovedImage {
  double turn_deg = 0;  // to the right, by the shift of what is about the horizon
  double change = 0;    // mean absolute difference of grey values; little while the vehicle stands
};

class ImageMotion {
 public:
  explicit ImageMotion(const Camera& camera);

  // From the image before to this one, 8 bit grey; nothing for the first.
  std::optional<MovedImage> to(const cv::Mat& gray);

 private:
  cv::Mat horizon_of(const cv::Mat& gray) const;

  double scale_;
  double focal_px_;        // of the small images
  double principal_y_px_;  // the same
  cv::Mat before_;
  cv::Mat window_;
};

// Of two series of one length, about 0; 0 if one of them is all 0.
double correlation(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace milepost
