#include "mapper/import/colmap_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using ::testing::HasSubstr;

// Models by COLMAP itself are read in tests/system/import_by_others_test.py.
class ColmapModelFiles : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  std::string error() const {
    const auto model = read_colmap_model(folder_.path());
    return model ? "" : model.error().line();
  }

  testing::TempFolder folder_;
};

template <class Value>
void append(std::string& bytes, Value value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

std::string binary_camera(std::int32_t model, const std::vector<double>& parameters) {
  std::string bytes;
  append(bytes, std::uint64_t{1});
  append(bytes, std::uint32_t{7});
  append(bytes, model);
  append(bytes, std::uint64_t{640});
  append(bytes, std::uint64_t{480});
  for (const double parameter : parameters) append(bytes, parameter);
  return bytes;
}

std::string binary_image(std::uint64_t points) {
  std::string bytes;
  append(bytes, std::uint64_t{1});
  append(bytes, std::uint32_t{3});
  for (const double value : {1.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0}) append(bytes, value);
  append(bytes, std::uint32_t{7});
  bytes += "left/0001.png";
  bytes += '\0';
  append(bytes, points);
  return bytes;
}

TEST_F(ColmapModelFiles, BinaryAndTextAreTheSame) {
  write("cameras.bin", binary_camera(4, {500, 510, 320, 240, -0.2, 0.05, 0.001, -0.002}));
  write("images.bin", binary_image(2) + std::string(48, 'x'));
  const auto binary = read_colmap_model(folder_.path());
  ASSERT_TRUE(binary.ok()) << binary.error().line();
  std::filesystem::remove(folder_ / "images.bin");
  write("cameras.txt", "# comment\n7 OPENCV 640 480 500 510 320 240 -0.2 0.05 0.001 -0.002\n");
  write("images.txt", "# comment\n3 1 0 0 0 1 2 3 7 left/0001.png\n\n");
  const auto text = read_colmap_model(folder_.path());
  ASSERT_TRUE(text.ok()) << text.error().line();
  for (const ColmapModel* model : {&*binary, &*text}) {
    ASSERT_EQ(model->images.size(), 1U);
    EXPECT_EQ(model->images[0].name, "left/0001.png");
    // The camera's place is where its own frame has its origin.
    EXPECT_TRUE(
        model->images[0].world_from_camera.translation().isApprox(Eigen::Vector3d(-1, -2, -3)));
    const Camera& camera = model->cameras.at(7);
    EXPECT_EQ(camera.width_px, 640);
    EXPECT_EQ(camera.pinhole.focal_y_px, 510);
    EXPECT_EQ(camera.pinhole.principal_x_px, 319.5);
    EXPECT_EQ(camera.lens.model(), LensModel::brown_conrady);
    EXPECT_EQ(camera.lens.coefficients()[3], -0.002);
  }
}

TEST_F(ColmapModelFiles, OneFocalLengthIsBoth) {
  write("cameras.txt", "1 SIMPLE_RADIAL 640 480 500 320 240 -0.1\n");
  write("images.txt", "");
  const auto model = read_colmap_model(folder_.path());
  ASSERT_TRUE(model.ok()) << model.error().line();
  const Camera& camera = model->cameras.at(1);
  EXPECT_EQ(camera.pinhole.focal_x_px, 500);
  EXPECT_EQ(camera.pinhole.focal_y_px, 500);
  EXPECT_EQ(camera.pinhole.principal_y_px, 239.5);
  EXPECT_EQ(camera.lens.coefficients()[0], -0.1);
}

TEST_F(ColmapModelFiles, WhatIsCutOrHostileIsRefused) {
  const std::string cameras = binary_camera(1, {500, 510, 320, 240});
  const std::string images = binary_image(2) + std::string(48, 'x');
  for (std::size_t length = 0; length < images.size(); ++length) {
    write("cameras.bin", cameras);
    write("images.bin", images.substr(0, length));
    EXPECT_THAT(error(), HasSubstr("ends within an image")) << length;
  }
  write("images.bin", images);
  for (std::size_t length = 0; length < cameras.size(); ++length) {
    write("cameras.bin", cameras.substr(0, length));
    EXPECT_THAT(error(), HasSubstr("ends within a camera")) << length;
  }
  write("cameras.bin", cameras);
  write("images.bin", binary_image(~std::uint64_t{0}));
  EXPECT_THAT(error(), HasSubstr("ends within an image"));
  write("cameras.bin", binary_camera(11, {}));
  EXPECT_THAT(error(), HasSubstr("no camera model 11"));
  write("cameras.bin", binary_camera(7, {500, 510, 320, 240, 0.9}));
  EXPECT_THAT(error(), HasSubstr("FOV is not known here"));
}

TEST_F(ColmapModelFiles, LinesThatAreNoneAreNamed) {
  EXPECT_THAT(error(), HasSubstr("neither images.bin nor images.txt"));
  write("images.txt", "1 1 0 0 0 0 0 0 1\n\n");
  write("cameras.txt", "1 PINHOLE 640 480 500 510 320\n");
  EXPECT_THAT(error(), HasSubstr("cameras.txt, line 1"));
  write("cameras.txt", "1 PINHOLE 640 480 500 510 320 240\n");
  EXPECT_THAT(error(), HasSubstr("images.txt, line 1"));
  write("images.txt", "1 2 0 0 0 0 0 0 1 a.png\n\n");
  EXPECT_THAT(error(), HasSubstr("no sound pose"));
  write("cameras.txt", "1 ORTHOGRAPHIC 640 480 500\n");
  EXPECT_THAT(error(), HasSubstr("no camera model 'ORTHOGRAPHIC'"));
}

}  // namespace
}  // namespace milepost
