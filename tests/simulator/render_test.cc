#include "tests/simulator/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/simulator/facade.h"
#include "tests/simulator/runs.h"
#include "tests/simulator/town.h"

namespace milepost::simulator {
namespace {

// A wall that faces south, its middle at the eye's height above the origin's north.
Scene wall_ahead(double north_m, double width_m, double height_m, const cv::Mat& image) {
  Scene scene;
  scene.surfaces.push_back(rectangle({-width_m / 2, north_m, height_m / 2}, {1, 0, 0}, {0, 0, -1},
                                     width_m, height_m, std::make_shared<Texture>(image),
                                     image.size()));
  return scene;
}

cv::Mat picture_of(const Scene& scene, const Pose& pose) {
  return render(scene, even_lighting(), kPaperCamera, pose);
}

cv::Mat gray(const cv::Mat& picture) {
  cv::Mat result;
  cv::cvtColor(picture, result, cv::COLOR_BGR2GRAY);
  return result;
}

TEST(Render, ShowsAPointWhereThePinholeSays) {
  cv::Mat image(640, 640, CV_8UC3, cv::Scalar::all(0));
  cv::rectangle(image, {480, 160}, {495, 175}, cv::Scalar::all(255), -1);
  // The white square's middle: 5.25 m right of the wall's middle and 4.75 m above it.
  const Scene scene = wall_ahead(20, 20, 20, image);
  for (const double roll_deg : {0.0, 20.0}) {
    const Pose pose{{1, 5, 0.5}, -3, 4, roll_deg};
    const cv::Mat picture = gray(picture_of(scene, pose));
    const cv::Rect region(300, 80, 170, 200);  // holds the square, and nothing but the wall
    const cv::Moments moments = cv::moments(picture(region));
    const cv::Point2d seen(moments.m10 / moments.m00 + region.x,
                           moments.m01 / moments.m00 + region.y);
    // By hand: turn the offset by heading, pitch and roll, then divide by the depth.
    const double rad = CV_PI / 180;
    const double h = pose.heading_deg * rad, p = pose.pitch_deg * rad, r = pose.roll_deg * rad;
    const double east = 5.25 - 1, north = 15, up = 4.75 - 0.5;
    const double right = east * std::cos(h) - north * std::sin(h);
    const double level = east * std::sin(h) + north * std::cos(h);
    const double depth = level * std::cos(p) + up * std::sin(p);
    const double down = -(up * std::cos(p) - level * std::sin(p));
    const double x = right * std::cos(r) + down * std::sin(r);
    const double y = down * std::cos(r) - right * std::sin(r);
    EXPECT_NEAR(seen.x, 300 + 357.5 * x / depth, 0.3) << roll_deg;
    EXPECT_NEAR(seen.y, 250 + 400.1 * y / depth, 0.3) << roll_deg;
  }
}

TEST(Render, NearHidesFar) {
  Scene scene = wall_ahead(20, 40, 40, cv::Mat(8, 8, CV_8UC3, cv::Scalar(10, 20, 200)));
  const Scene near = wall_ahead(10, 4, 4, cv::Mat(8, 8, CV_8UC3, cv::Scalar(200, 20, 10)));
  const cv::Vec3b near_colour(200, 20, 10);
  for (const bool near_first : {false, true}) {
    std::vector<Surface> surfaces = {scene.surfaces[0], near.surfaces[0]};
    if (near_first) std::swap(surfaces[0], surfaces[1]);
    const cv::Mat picture = picture_of({surfaces}, {});
    EXPECT_EQ(picture.at<cv::Vec3b>(250, 300), near_colour);
    EXPECT_EQ(picture.at<cv::Vec3b>(250, 500), cv::Vec3b(10, 20, 200));
  }
}

TEST(Render, HidesWhatLiesBehindTheCamera) {
  const Scene scene = wall_ahead(-10, 100, 100, cv::Mat(8, 8, CV_8UC3, cv::Scalar::all(0)));
  const cv::Mat picture = picture_of(scene, {});
  double darkest = 0;
  cv::minMaxLoc(gray(picture), &darkest);
  EXPECT_GT(darkest, 100);  // sky everywhere
}

TEST(Render, ShowsGroundFromUnderTheCameraOn) {
  const cv::Vec3b green(20, 200, 10);
  Scene scene;
  const cv::Mat image(8, 8, CV_8UC3, green);
  scene.surfaces.push_back(rectangle({-200, 400, 0}, {1, 0, 0}, {0, -1, 0}, 400, 800,
                                     std::make_shared<Texture>(image), image.size()));
  const cv::Mat picture = picture_of(scene, {{0, 0, 1.5}});
  for (const int y : {260, 300, 499}) {
    for (const int x : {0, 300, 599})
      EXPECT_EQ(picture.at<cv::Vec3b>(y, x), green) << x << "," << y;
  }
  EXPECT_NE(picture.at<cv::Vec3b>(245, 300), green);
}

TEST(Render, DetailFinerThanAPixelFades) {
  cv::Mat checkers(640, 640, CV_8UC3);
  for (int y = 0; y < checkers.rows; ++y) {
    for (int x = 0; x < checkers.cols; ++x) {
      checkers.at<cv::Vec3b>(y, x) = (x + y) % 2 == 0 ? cv::Vec3b::all(0) : cv::Vec3b::all(255);
    }
  }
  const Scene scene = wall_ahead(30, 10, 10, checkers);  // five texels per pixel
  cv::Scalar mean, deviation;
  for (const double heading_deg : {0.0, 30.0}) {
    // A frontal view, and an oblique one from beside the wall's edge.
    const Point eye = heading_deg == 0 ? Point(0, 0, 0) : Point(-12, 22, 0);
    const cv::Mat picture = gray(picture_of(scene, {eye, heading_deg}));
    const double x = heading_deg == 0 ? 300 : 300 + 357.5 * std::tan((56.31 - 30) * CV_PI / 180);
    const cv::Rect middle(static_cast<int>(x) - 20, 230, 40, 40);
    cv::meanStdDev(picture(middle), mean, deviation);
    EXPECT_NEAR(mean[0], 127.5, 4) << heading_deg;
    EXPECT_LT(deviation[0], 6) << heading_deg;
  }
}

// Scale against depth: the basis of the tracklet method.

constexpr double kWallM = 40;  // north

cv::Mat picture_at_depth(const Scene& scene, double depth_m) {
  return gray(picture_of(scene, {{0, kWallM - depth_m, 0}}));
}

TEST(Render, ADiscsFeatureScaleGrowsAsOneOverDepth) {
  cv::Mat image(10 * 64, 14 * 64, CV_8UC3, cv::Scalar::all(180));
  cv::circle(image, {image.cols / 2, image.rows / 2}, 20, cv::Scalar::all(40), -1, cv::LINE_AA);
  const Scene scene = wall_ahead(kWallM, 14, 10, image);
  const auto sift = cv::SIFT::create();
  double product_at_10_m = 0;
  for (const double depth_m : {10.0, 12.0, 15.0, 19.0, 24.0, 30.0}) {
    std::vector<cv::KeyPoint> keypoints;
    cv::Mat mask(500, 600, CV_8UC1, cv::Scalar(0));
    cv::circle(mask, {300, 250}, 4, 255, -1);
    sift->detect(picture_at_depth(scene, depth_m), keypoints, mask);
    ASSERT_FALSE(keypoints.empty()) << depth_m;
    const auto strongest =
        std::max_element(keypoints.begin(), keypoints.end(),
                         [](const auto& a, const auto& b) { return a.response < b.response; });
    const double product = strongest->size * depth_m;
    if (product_at_10_m == 0) product_at_10_m = product;
    EXPECT_NEAR(product / product_at_10_m, 1, 0.03) << depth_m;
  }
}

struct Features {
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
};

Features features_of(const cv::Mat& picture) {
  Features features;
  cv::SIFT::create()->detectAndCompute(picture, cv::noArray(), features.keypoints,
                                       features.descriptors);
  return features;
}

std::vector<cv::DMatch> distinct_matches(const Features& query, const Features& train) {
  std::vector<std::vector<cv::DMatch>> pairs;
  cv::BFMatcher().knnMatch(query.descriptors, train.descriptors, pairs, 2);
  std::vector<cv::DMatch> matches;
  for (const auto& pair : pairs) {
    if (pair[0].distance < 0.7F * pair[1].distance) matches.push_back(pair[0]);
  }
  return matches;
}

TEST(Render, AFacadesFeatureScalesGrowAsOneOverDepth) {
  cv::RNG random(5);
  const Scene scene = wall_ahead(kWallM, 14, 10, paint_facade({14, 10}, true, random));
  constexpr double kNearestM = 10;
  const Features nearest = features_of(picture_at_depth(scene, kNearestM));
  const cv::Point2f centre(300, 250);
  for (const double depth_m : {13.0, 17.0, 22.0, 30.0}) {
    const Features far = features_of(picture_at_depth(scene, depth_m));
    const auto zoom = static_cast<float>(depth_m / kNearestM);
    std::vector<double> ratios;
    for (const cv::DMatch& match : distinct_matches(far, nearest)) {
      const cv::KeyPoint& a = far.keypoints[match.queryIdx];
      const cv::KeyPoint& b = nearest.keypoints[match.trainIdx];
      const cv::Point2f expected = (a.pt - centre) * zoom + centre;
      if (cv::norm(b.pt - expected) > 1.5 * zoom) continue;  // another place on the wall
      ratios.push_back(b.size / (a.size * zoom));
    }
    ASSERT_GE(ratios.size(), 40U) << depth_m;
    std::nth_element(ratios.begin(), ratios.begin() + ratios.size() / 2, ratios.end());
    EXPECT_NEAR(ratios[ratios.size() / 2], 1, 0.03) << depth_m;
  }
}

TEST(Town, GivesSeveralHundredFeaturesThatMatchFromFrameToFrame) {
  const Town town = make_town(1);
  const Lighting lighting = light_town(town, noon_light());
  const Path& path = town.network.route("town-main")->path;
  const auto picture_at = [&](double along_m) {
    const cv::Vec2d at = path.position_at({along_m, kLaneM});
    const double up_m = town.network.terrain.height_m(at) + 1.5;
    const Pose pose{{at[0], at[1], up_m}, path.heading_rad_at(along_m) * 180 / CV_PI};
    return gray(render(town.scene, lighting, kPaperCamera, pose));
  };
  const Features first = features_of(picture_at(60));
  const Features second = features_of(picture_at(62));
  EXPECT_GT(first.keypoints.size(), 700U);
  EXPECT_GT(distinct_matches(first, second).size(), 200U);
}

TEST(Render, CutOutsShowWhatLiesBehind) {
  cv::Mat image(64, 64, CV_8UC4, cv::Scalar(10, 20, 200, 255));
  image(cv::Rect(0, 0, 32, 64)).setTo(cv::Scalar(10, 20, 200, 0));
  Scene scene = wall_ahead(10, 4, 4, image);
  scene.surfaces[0].is_cut_out = true;
  const cv::Vec3b behind(200, 20, 10);
  scene.surfaces.push_back(wall_ahead(20, 40, 40, cv::Mat(8, 8, CV_8UC3, behind)).surfaces[0]);
  const cv::Mat picture = picture_of(scene, {});
  EXPECT_EQ(picture.at<cv::Vec3b>(250, 270), behind);
  EXPECT_EQ(picture.at<cv::Vec3b>(250, 330), cv::Vec3b(10, 20, 200));
}

TEST(Render, AParallelProjectionKeepsSizes) {
  cv::Mat image(100, 100, CV_8UC3, cv::Scalar::all(0));
  cv::rectangle(image, {30, 40}, {49, 69}, cv::Scalar::all(255), -1);
  Scene scene;  // on the ground, and again 3 m above it, 40 m further east
  for (const auto& [west, up] : {std::pair{0.0, 0.0}, std::pair{40.0, 3.0}}) {
    scene.surfaces.push_back(rectangle({west, 10, up}, {1, 0, 0}, {0, -1, 0}, 10, 10,
                                       std::make_shared<Texture>(image), image.size()));
  }
  const Projection down =
      Projection::parallel({0.1, 9.9, 50}, {1, 0, 0}, {0, -1, 0}, {0, 0, -1}, 0.2, {260, 50});
  const cv::Mat picture = gray(render(scene, even_lighting(), down));
  for (const int west_px : {0, 200}) {
    const cv::Moments moments = cv::moments(picture(cv::Rect(west_px, 0, 50, 50)));
    EXPECT_NEAR(moments.m00 / 255, 10 * 15, 1);
    EXPECT_NEAR(moments.m10 / moments.m00, 15 + 4.5, 0.05);
    EXPECT_NEAR(moments.m01 / moments.m00, 20 + 7, 0.05);
  }
}

}  // namespace
}  // namespace milepost::simulator
