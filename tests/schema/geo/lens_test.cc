#include "schema/geo/lens.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include <opencv2/calib3d.hpp>

#include "schema/geo/camera.h"

namespace milepost {
namespace {

struct Named {
  const char* name;
  LensModel model;
  std::vector<double> coefficients;
  double widest;  // radius that is tested

  friend void PrintTo(const Named& lens, std::ostream* out) { *out << lens.name; }
};

const std::vector<Named> kLenses = {
    {"none", LensModel::brown_conrady, {}, 3},
    {"barrel", LensModel::brown_conrady, {-0.28, 0.07, 0.0002, -0.0003, -0.009}, 0.9},
    {"pincushion", LensModel::brown_conrady, {0.12, 0.02}, 1.2},
    {"decentred", LensModel::brown_conrady, {-0.05, 0.01, 0.004, -0.003}, 1},
    {"rational", LensModel::brown_conrady, {1.2, 0.4, 1e-4, 2e-4, 0.01, 1.5, 0.7, 0.06}, 2},
    {"equidistant", LensModel::kannala_brandt, {}, 3.5},
    {"fisheye", LensModel::kannala_brandt, {-0.013, 0.021, -0.014, 0.003}, 3},
};

class OfLens : public ::testing::TestWithParam<Named> {
 protected:
  Lens lens() const { return *Lens::make(GetParam().model, GetParam().coefficients); }

  std::vector<Eigen::Vector2d> points() const {
    std::vector<Eigen::Vector2d> points = {{0, 0}, {1e-6, 0}, {0, -1e-3}};
    std::mt19937 random(7);
    std::uniform_real_distribution<double> within(-1, 1);
    while (points.size() < 200) {
      const Eigen::Vector2d point(within(random), within(random));
      if (point.norm() <= 1) points.push_back(GetParam().widest * point);
    }
    return points;
  }
};
INSTANTIATE_TEST_SUITE_P(Lenses, OfLens, ::testing::ValuesIn(kLenses),
                         [](const auto& chosen) { return std::string(chosen.param.name); });

TEST_P(OfLens, ShowsWhereOpenCvDoes) {
  std::vector<double> coefficients = GetParam().coefficients;
  const bool is_fisheye = GetParam().model == LensModel::kannala_brandt;
  coefficients.resize(is_fisheye ? 4 : 8);
  for (const Eigen::Vector2d& seen : points()) {
    const std::vector<cv::Point3d> point = {{seen.x(), seen.y(), 1}};
    std::vector<cv::Point2d> expected;
    const cv::Vec3d none;
    const cv::Matx33d plane = cv::Matx33d::eye();
    if (is_fisheye) {
      cv::fisheye::projectPoints(point, expected, none, none, plane, coefficients);
    } else {
      cv::projectPoints(point, none, none, plane, coefficients, expected);
    }
    const auto shown = lens().distorted(seen);
    ASSERT_TRUE(shown) << seen.transpose();
    EXPECT_NEAR(shown->x(), expected[0].x, 1e-9);
    EXPECT_NEAR(shown->y(), expected[0].y, 1e-9);
  }
}

TEST_P(OfLens, UndistortsWhatItDistorts) {
  for (const Eigen::Vector2d& seen : points()) {
    const auto back = lens().undistorted(*lens().distorted(seen));
    ASSERT_TRUE(back) << seen.transpose();
    EXPECT_NEAR((back->seen - seen).norm(), 0, 1e-7);
  }
}

TEST_P(OfLens, TellsHowMuchItMagnifies) {
  constexpr double kStep = 1e-5;
  for (const Eigen::Vector2d& seen : points()) {
    const Eigen::Vector2d shown = *lens().distorted(seen);
    const auto corner = [&](double x, double y) {
      return lens().undistorted(shown + kStep * Eigen::Vector2d(x, y))->seen;
    };
    if (seen.norm() > 0.99 * GetParam().widest) continue;  // the corners may lie beyond
    const Eigen::Vector2d across = corner(1, 0) - corner(-1, 0);
    const Eigen::Vector2d down = corner(0, 1) - corner(0, -1);
    const double area = (across.x() * down.y() - across.y() * down.x()) / (4 * kStep * kStep);
    EXPECT_NEAR(lens().undistorted(shown)->magnification, std::sqrt(area), 1e-3 * std::sqrt(area));
  }
}

TEST(Lens, EndsItsFieldOfViewWhereItsImageFolds) {
  // The image of x (1 - 0.3 x^2) turns back at 1 / sqrt(0.9).
  const Lens lens = *Lens::make(LensModel::brown_conrady, {-0.3});
  EXPECT_TRUE(lens.distorted({1, 0}));
  EXPECT_FALSE(lens.distorted({1.06, 0}));
  EXPECT_FALSE(lens.undistorted({0.71, 0}));  // beyond 0.7027, where it turns
  EXPECT_TRUE(lens.undistorted({0.69, 0}));
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(lens.distorted({nothing, 0}));
  EXPECT_FALSE(lens.undistorted({nothing, 0}));
}

TEST(Lens, SeesNothingAtTheHorizonOfAFisheye) {
  const Lens lens = *Lens::make(LensModel::kannala_brandt, {});
  const auto at_deg = [](double degrees) { return std::tan(degrees * kRadPerDeg); };
  EXPECT_TRUE(lens.distorted({at_deg(74), 0}));
  EXPECT_FALSE(lens.distorted({at_deg(76), 0}));
  EXPECT_TRUE(lens.undistorted({0, 74 * kRadPerDeg}));
  EXPECT_FALSE(lens.undistorted({0, 76 * kRadPerDeg}));
}

TEST(Lens, RefusesWhatIsNoLens) {
  const auto what_of = [](LensModel model, const std::vector<double>& coefficients) {
    const Result<Lens> lens = Lens::make(model, coefficients);
    return lens ? std::string() : lens.error().what;
  };
  EXPECT_EQ(what_of(LensModel::kannala_brandt, {0, 0, 0, 0, 0}), "it has 5 coefficients");
  EXPECT_EQ(what_of(LensModel::pinhole, {0.1}), "it has 1 coefficients");
  EXPECT_EQ(what_of(LensModel::brown_conrady, {0, std::nan("")}), "k2 is not finite");
  EXPECT_EQ(what_of(LensModel::brown_conrady, {-200}),
            "its image folds within 6 degrees of the optical axis");
}

TEST(Camera, ConvertsBetweenTheLensAndItsPinhole) {
  Camera camera{640, 480, {500, 510, 321, 243}, {}};
  const Eigen::Vector2d corner(12, 34);
  EXPECT_EQ(camera.pinhole_from_image(corner)->pinhole_px, corner);
  EXPECT_EQ(*camera.image_from_pinhole(corner), corner);
  camera.lens = *Lens::make(LensModel::brown_conrady, {-0.28, 0.07});
  const auto seen = camera.pinhole_from_image(corner);
  ASSERT_TRUE(seen);
  EXPECT_GT((seen->pinhole_px - Eigen::Vector2d(321, 243)).norm(),
            20 + (corner - Eigen::Vector2d(321, 243)).norm());  // a barrel's corners lie outside
  EXPECT_GT(seen->magnification, 1.05);
  EXPECT_NEAR((*camera.image_from_pinhole(seen->pinhole_px) - corner).norm(), 0, 1e-6);
}

}  // namespace
}  // namespace milepost
