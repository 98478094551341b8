#include "tests/simulator/aerial.h"

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <fstream>
#include <memory>

#include <nlohmann/json.hpp>

#include "tests/simulator/sensors.h"
#include "tests/support/temp_folder.h"

namespace milepost::simulator {
namespace {

using milepost::testing::TempFolder;

const Town& town() {
  static const Town made = make_town(1, GroundDetail::aerial);
  return made;
}
const Lighting& lighting() {
  static const Lighting made = light_town(town(), noon_light());
  return made;
}

// Part of the town, a little north of the first crossing.
constexpr double kPixelM = 0.2;
const OrthoPlan kPart{{-40, 120}, {60, 180}, kPixelM};

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

struct Image {
  std::unique_ptr<GDALDataset> dataset;
  cv::Mat green;
};

Image read_image(const std::filesystem::path& path) {
  GDALAllRegister();
  Image image{std::unique_ptr<GDALDataset>(
                  GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY)),
              {}};
  if (!image.dataset) return image;
  image.green.create(image.dataset->GetRasterYSize(), image.dataset->GetRasterXSize(), CV_8UC1);
  const CPLErr done = image.dataset->GetRasterBand(2)->RasterIO(
      GF_Read, 0, 0, image.green.cols, image.green.rows, image.green.data, image.green.cols,
      image.green.rows, GDT_Byte, 0, 0);
  EXPECT_EQ(done, CE_None);
  return image;
}

TEST(Orthoimage, IsTheSameOnAnyNumberOfThreads) {
  const TempFolder folder;
  const OrthoPlan small{{-10, 120}, {30, 150}, 0.5};
  ASSERT_TRUE(write_orthoimage(town(), lighting(), small, folder / "one.tif", 1).ok());
  ASSERT_TRUE(write_orthoimage(town(), lighting(), small, folder / "two.tif", 2).ok());
  EXPECT_EQ(bytes_of(folder / "one.tif"), bytes_of(folder / "two.tif"));
}

TEST(Orthoimage, LiesOnAGridAboutTheOrigin) {
  const TempFolder folder;
  ASSERT_TRUE(write_orthoimage(town(), lighting(), kPart, folder / "part.tif", 2).ok());
  const Image image = read_image(folder / "part.tif");
  ASSERT_TRUE(image.dataset);
  EXPECT_EQ(image.green.size(), cv::Size(500, 300));
  double transform[6];
  ASSERT_EQ(image.dataset->GetGeoTransform(transform), CE_None);
  EXPECT_EQ(transform[0], -40);
  EXPECT_EQ(transform[1], kPixelM);
  EXPECT_EQ(transform[3], 180);
  EXPECT_EQ(transform[5], -kPixelM);
  EXPECT_STREQ(image.dataset->GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE"), "DEFLATE");
  // The drives' local frame and the grid agree on positions.
  OGRSpatialReference wgs84;
  wgs84.importFromEPSG(4326);
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> to_grid(
      OGRCreateCoordinateTransformation(&wgs84, image.dataset->GetSpatialRef()));
  ASSERT_TRUE(to_grid);
  for (const Point& point : {Point(0, 0, 0), Point(300, -90, 0), Point(-250, 380, 0)}) {
    const GeoPoint geo = geo_from_point(point);
    double east = geo.longitude_deg;
    double north = geo.latitude_deg;
    ASSERT_TRUE(to_grid->Transform(1, &east, &north));
    EXPECT_NEAR(east, point[0], 0.01);
    EXPECT_NEAR(north, point[1], 0.01);
  }
}

double mean_of(const cv::Mat& green, const cv::Vec2d& from, const cv::Vec2d& to) {
  double sum = 0;
  constexpr int kSteps = 60;
  for (int i = 0; i < kSteps; ++i) {
    const cv::Vec2d at = from + (to - from) * ((i + 0.5) / kSteps);
    const int column = static_cast<int>((at[0] - kPart.south_west[0]) / kPixelM);
    const int row = static_cast<int>((kPart.north_east[1] - at[1]) / kPixelM);
    if (column < 0 || row < 0 || column >= green.cols || row >= green.rows) return -1;
    sum += green.at<uchar>(row, column);
  }
  return sum / kSteps;
}

TEST(Walls, AreWhereTheImageHasEdges) {
  const TempFolder folder;
  ASSERT_TRUE(write_orthoimage(town(), lighting(), kPart, folder / "part.tif", 2).ok());
  ASSERT_TRUE(write_walls(town(), folder / "walls.geojson").ok());
  const Image image = read_image(folder / "part.tif");
  const auto walls = nlohmann::json::parse(bytes_of(folder / "walls.geojson"));
  ASSERT_EQ(walls["features"].size(), town().buildings.size());
  const LocalFrame frame(kOrigin);
  int edges = 0, seen = 0;
  for (const auto& feature : walls["features"]) {
    EXPECT_GT(feature["properties"]["height_m"].get<double>(), 2);
    const auto& ring = feature["geometry"]["coordinates"][0];
    ASSERT_EQ(ring.size(), 5U);
    for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
      const auto enu = [&](const nlohmann::json& lon_lat) {
        const EnuPoint at =
            frame.enu_from_geo({lon_lat[1].get<double>(), lon_lat[0].get<double>(), 110});
        return cv::Vec2d(at.east_m, at.north_m);
      };
      const cv::Vec2d from = enu(ring[i]);
      const cv::Vec2d to = enu(ring[i + 1]);
      const cv::Vec2d along = (to - from) * (1 / cv::norm(to - from));
      const cv::Vec2d out(along[1], -along[0]);
      // Roofs hang over by up to 0.4 m: compare 1 m outside with 1 m inside.
      const double outside = mean_of(image.green, from + out, to + out);
      const double inside = mean_of(image.green, from - out, to - out);
      if (outside < 0 || inside < 0) continue;
      ++edges;
      if (std::abs(outside - inside) > 10) ++seen;
    }
  }
  EXPECT_GT(edges, 40);
  EXPECT_GT(seen, edges * 6 / 10);
}

TEST(Orthoimage, SaysWhereItCannotWrite) {
  const Status status = write_orthoimage(town(), lighting(), kPart, "/nowhere/at/all/town.tif", 1);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::io);
  EXPECT_NE(status.error().line().find("/nowhere/at/all/town.tif: cannot be written"),
            std::string::npos);
}

}  // namespace
}  // namespace milepost::simulator
