#include "mapper/import/ros/camera_of_info.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace milepost::ros {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

CameraInfo info_of(std::string_view model, std::vector<double> distortion) {
  CameraInfo info;
  info.width_px = 640;
  info.height_px = 480;
  info.distortion_model = model;
  info.distortion = std::move(distortion);
  info.intrinsics = {500, 0, 319.5, 0, 501, 239.5, 0, 0, 1};
  info.projection = {400, 0, 300, 0, 0, 401, 200, 0, 0, 0, 1, 0};
  return info;
}

Camera camera(const CameraInfo& info, bool is_rectified = false) {
  const auto found = camera_of(info, is_rectified);
  EXPECT_TRUE(found.ok()) << found.error().line();
  EXPECT_TRUE(found && *found);
  return found && *found ? **found : Camera();
}

TEST(CameraOfInfo, HasTheLensOfEachModel) {
  const Camera plumb_bob = camera(info_of("plumb_bob", {-0.1, 0.02, 0.001, -0.002, 0.003}));
  EXPECT_EQ(plumb_bob.width_px, 640);
  EXPECT_EQ(plumb_bob.height_px, 480);
  EXPECT_EQ(plumb_bob.pinhole, (Pinhole{500, 501, 319.5, 239.5}));
  EXPECT_EQ(plumb_bob.lens.model(), LensModel::brown_conrady);
  EXPECT_THAT(plumb_bob.lens.coefficients(),
              ElementsAre(-0.1, 0.02, 0.001, -0.002, 0.003, 0, 0, 0));
  const Camera rational =
      camera(info_of("rational_polynomial", {0.1, 0.02, 0, 0, 0.003, 0.2, 0.05, 0.01, 0, 0, 0, 0}));
  EXPECT_THAT(rational.lens.coefficients(), ElementsAre(0.1, 0.02, 0, 0, 0.003, 0.2, 0.05, 0.01));
  for (const char* const fisheye : {"equidistant", "fisheye"}) {
    const Camera wide = camera(info_of(fisheye, {0.01, 0.02, -0.003, 0}));
    EXPECT_EQ(wide.lens.model(), LensModel::kannala_brandt);
    EXPECT_THAT(wide.lens.coefficients(), ElementsAre(0.01, 0.02, -0.003, 0));
    // Without coefficients it is a fisheye all the same.
    EXPECT_EQ(camera(info_of(fisheye, {})).lens.model(), LensModel::kannala_brandt);
  }
}

TEST(CameraOfInfo, WithoutDistortionIsAPinhole) {
  for (const char* const model : {"plumb_bob", "rational_polynomial", "", "none"})
    EXPECT_TRUE(camera(info_of(model, {0, 0, 0, 0, 0})).lens.is_pinhole()) << model;
}

TEST(CameraOfInfo, RectifiedImagesHaveTheProjectionAndNoLens) {
  const Camera rectified = camera(info_of("plumb_bob", {-0.1, 0.02}), true);
  EXPECT_EQ(rectified.pinhole, (Pinhole{400, 401, 300, 200}));
  EXPECT_TRUE(rectified.lens.is_pinhole());
}

TEST(CameraOfInfo, OfAPartInItsBinning) {
  CameraInfo info = info_of("plumb_bob", {});
  info.binning_x = 2;
  info.binning_y = 4;
  // The centre of the full image stays the centre.
  const Camera binned = camera(info);
  EXPECT_EQ(binned.width_px, 320);
  EXPECT_EQ(binned.height_px, 120);
  EXPECT_EQ(binned.pinhole, (Pinhole{250, 125.25, 159.5, 59.5}));
  info.roi_x_px = 20;
  info.roi_y_px = 40;
  info.roi_width_px = 600;
  info.roi_height_px = 400;
  const Camera part = camera(info);
  EXPECT_EQ(part.width_px, 300);
  EXPECT_EQ(part.height_px, 100);
  EXPECT_EQ(part.pinhole, (Pinhole{250, 125.25, 149.5, 49.5}));
}

TEST(CameraOfInfo, NothingWithoutACalibration) {
  CameraInfo info = info_of("", {});
  info.intrinsics = {};
  const auto none = camera_of(info, false);
  ASSERT_TRUE(none.ok()) << none.error().line();
  EXPECT_FALSE(*none);
}

TEST(CameraOfInfo, NamesWhatIsWrong) {
  const auto refusal = [](const CameraInfo& info) {
    const auto found = camera_of(info, false);
    return found ? "accepted" : found.error().line();
  };
  EXPECT_THAT(refusal(info_of("double_sphere", {0.1})),
              HasSubstr("has the distortion model 'double_sphere', which is not known; name a file "
                        "with the camera by --camera"));
  EXPECT_NE(refusal(info_of("plumb_bob", {0, 0, 0, 0, 0, 0, 0, 0, 1})), "accepted");
  CameraInfo info = info_of("plumb_bob", {});
  info.height_px = 0;
  EXPECT_THAT(refusal(info), HasSubstr("has 640 x 0 pixels"));
  info.height_px = 4'000'000'000U;
  EXPECT_THAT(refusal(info), HasSubstr("has 640 x 4000000000 pixels"));
}

}  // namespace
}  // namespace milepost::ros
