#include "tests/simulator/shadow.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/simulator/render.h"

namespace milepost::simulator {
namespace {

const cv::Mat kGrey(8, 8, CV_8UC3, cv::Scalar::all(128));

Surface wall(double north_m, double width_m, double height_m) {
  return rectangle({-width_m / 2, north_m, height_m}, {1, 0, 0}, {0, 0, -1}, width_m, height_m,
                   std::make_shared<Texture>(kGrey), kGrey.size());
}

// Ground, and a wall 6 m high along north 0; the sun stands in the south, 45 degrees high.
Scene wall_in_the_sun() {
  Scene scene;
  scene.surfaces.push_back(rectangle({-40, 40, 0}, {1, 0, 0}, {0, -1, 0}, 80, 80,
                                     std::make_shared<Texture>(kGrey), kGrey.size()));
  scene.surfaces.push_back(wall(0, 30, 6));
  return scene;
}

Light southern_sun() {
  Light light;
  light.sun_azimuth_deg = 180;
  light.sun_elevation_deg = 45;
  return light;
}

TEST(ShadowMap, AWallThrowsAShadowAsLongAsTheSunIsLow) {
  const ShadowMap shadows(wall_in_the_sun(), southern_sun().to_sun());
  const Point up(0, 0, 1);
  EXPECT_EQ(shadows.sunlight({0, -3, 0}, up), 1);   // before the wall
  EXPECT_EQ(shadows.sunlight({0, 3, 0}, up), 0);    // behind it
  EXPECT_EQ(shadows.sunlight({0, 5.6, 0}, up), 0);  // 6 m high, 6 m long
  EXPECT_EQ(shadows.sunlight({0, 6.4, 0}, up), 1);
  EXPECT_EQ(shadows.sunlight({0, 3, 3.5}, up), 1);        // over the shadow
  EXPECT_EQ(shadows.sunlight({18, 3, 0}, up), 1);         // beside it
  EXPECT_EQ(shadows.sunlight({0, 0, 3}, {0, -1, 0}), 1);  // the wall itself
}

TEST(ShadowMap, CutOutsLetTheSunThroughWhereTheyAreClear) {
  cv::Mat halves(64, 64, CV_8UC4, cv::Scalar(90, 90, 90, 255));
  halves(cv::Rect(0, 0, 32, 64)).setTo(cv::Scalar(90, 90, 90, 0));
  Scene scene = wall_in_the_sun();
  Surface& surface = scene.surfaces[1];
  surface.texture = std::make_shared<Texture>(halves);
  surface.map.u_per_m *= 8;
  surface.map.v_per_m *= 8;
  surface.is_cut_out = true;
  const ShadowMap shadows(scene, southern_sun().to_sun());
  EXPECT_EQ(shadows.sunlight({-8, 3, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(shadows.sunlight({8, 3, 0}, {0, 0, 1}), 0);
}

TEST(SkyView, IsNarrowInACanyonAndWideAboveIt) {
  cv::Mat height(100, 60, CV_32F, cv::Scalar(0));
  height(cv::Rect(0, 0, 22, 100)) = 16;
  height(cv::Rect(38, 0, 22, 100)) = 16;
  const SkyView view(height, {-30, -50});
  const double canyon = view.open_share({0, 0}, 0);
  // Between endless walls of height h, 8 m away: cos^2 of the horizon, averaged around.
  double expected = 0;
  for (int i = 0; i < 360; ++i) {
    const double slope = 16 / 8.0 * std::abs(std::sin(i * CV_PI / 180));
    expected += 1 / (1 + slope * slope) / 360;
  }
  EXPECT_NEAR(canyon, expected, 0.08);
  EXPECT_EQ(view.open_share({0, 0}, 20), 1);
  EXPECT_EQ(view.open_share({500, 0}, 0), 1);  // out of the town
}

TEST(Render, ShadowsAreDarkerThanSunlitGround) {
  const Scene scene = wall_in_the_sun();
  const Light light = southern_sun();
  const Lighting lighting{
      light, std::make_shared<Sky>(light), std::make_shared<ShadowMap>(scene, light.to_sun()),
      std::make_shared<SkyView>(cv::Mat(4, 4, CV_32F, cv::Scalar(0)), cv::Vec2d()),
      [](const cv::Vec2d&) { return 0.0; }};
  const Projection from_above =
      Projection::parallel({-10, 20, 50}, {1, 0, 0}, {0, -1, 0}, {0, 0, -1}, 0.5, {40, 80});
  const cv::Mat picture = render(scene, lighting, from_above);
  const auto grey_at = [&](double north_m) {
    return static_cast<int>(picture.at<cv::Vec3b>(static_cast<int>((20 - north_m) / 0.5), 20)[1]);
  };
  EXPECT_NEAR(grey_at(-5), grey_at(10), 2);
  EXPECT_LT(grey_at(3), grey_at(-5) * 0.75);
  // Moving objects cast shadows, too: a box 2 m high in front of the wall.
  Moving moving;
  moving.shades.push_back({{0, -6, 0}, {1, 0}, 3, 1, 2});
  const cv::Mat with_box = render(scene, lighting, from_above, moving);
  EXPECT_LT(with_box.at<cv::Vec3b>(50, 20)[1],
            picture.at<cv::Vec3b>(50, 20)[1] * 0.75);                        // north -5
  EXPECT_EQ(with_box.at<cv::Vec3b>(60, 20), picture.at<cv::Vec3b>(60, 20));  // south of the box
}

}  // namespace
}  // namespace milepost::simulator
