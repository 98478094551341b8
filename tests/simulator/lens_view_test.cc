#include "tests/simulator/lens_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include <opencv2/imgproc.hpp>

namespace milepost::simulator {
namespace {

constexpr Pinhole kPinhole{200, 210, 161, 118};

Camera with(LensModel model, const std::vector<double>& coefficients) {
  return {320, 240, kPinhole, *Lens::make(model, coefficients)};
}

// A picture with a soft spot at a pixel.
cv::Mat spot(const Camera& camera, const Eigen::Vector2d& at_px) {
  cv::Mat picture(camera.height_px, camera.width_px, CV_8UC3, cv::Scalar::all(40));
  picture.forEach<cv::Vec3b>([&](cv::Vec3b& pixel, const int* at) {
    const double squared = (Eigen::Vector2d(at[1], at[0]) - at_px).squaredNorm();
    pixel += cv::Vec3b::all(cv::saturate_cast<std::uint8_t>(200 * std::exp(-squared / 18)));
  });
  return picture;
}

Eigen::Vector2d brightest_of(const cv::Mat& picture) {
  cv::Mat gray;
  cv::cvtColor(picture, gray, cv::COLOR_BGR2GRAY);
  gray -= cv::Scalar(60);
  const cv::Moments moments = cv::moments(gray);
  return {moments.m10 / moments.m00, moments.m01 / moments.m00};
}

TEST(LensView, ShowsThePictureOfAPinholeAsItIs) {
  const LensView view(with(LensModel::pinhole, {}));
  EXPECT_EQ(view.pinhole().width_px, 320);
  const cv::Mat picture = spot(view.pinhole(), {100, 90});
  EXPECT_EQ(view.shown(picture).data, picture.data);
}

TEST(LensView, ShowsEverythingWhereTheLensDoes) {
  for (const Camera& camera :
       {with(LensModel::brown_conrady, {-0.22, 0.04, 0.001, -0.001}),
        with(LensModel::kannala_brandt, {-0.02, 0.01}), with(LensModel::brown_conrady, {0.1})}) {
    SCOPED_TRACE(name_of(camera.lens.model()));
    const LensView view(camera);
    for (const Eigen::Vector2d& place :
         std::initializer_list<Eigen::Vector2d>{{161, 118}, {60, 60}, {280, 170}}) {
      const Eigen::Vector2d point = view.pinhole().pinhole.project(
          camera.pinhole.unproject(camera.pinhole_from_image(place)->pinhole_px.x(),
                                   camera.pinhole_from_image(place)->pinhole_px.y()));
      const cv::Mat shown = view.shown(spot(view.pinhole(), point));
      EXPECT_EQ(shown.size(), cv::Size(320, 240));
      EXPECT_LT((brightest_of(shown) - place).norm(), 0.05) << place.transpose();
      EXPECT_EQ(shown.at<cv::Vec3b>(20, 20), cv::Vec3b::all(40));  // a corner is shown, too
    }
  }
}

TEST(LensView, IsBlackBeyondTheFieldOfView) {
  const LensView view(with(LensModel::brown_conrady, {-0.9}));  // folds at 0.61, 80 pixels
  const cv::Mat shown = view.shown(spot(view.pinhole(), {100, 100}));
  EXPECT_EQ(shown.at<cv::Vec3b>(118, 10), cv::Vec3b::all(0));
  EXPECT_NE(shown.at<cv::Vec3b>(118, 161), cv::Vec3b::all(0));
}

}  // namespace
}  // namespace milepost::simulator
