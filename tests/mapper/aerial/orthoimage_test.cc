#include "mapper/aerial/orthoimage.h"

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>

#include "mapper/aerial/ground_frame.h"
#include "schema/base/file.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using testing::TempFolder;

const GeoPoint kPlace{60.00123456, 10.50123456, 0};
constexpr int kSide = 200;          // pixels of the images below
constexpr double kMercatorM = 0.4;  // a pixel of EPSG:3857: 0.2 m on the ground at latitude 60

TEST(GroundFrame, MetresAreThoseOfTheEllipsoid) {
  const GroundFrame frame(kPlace);
  EXPECT_LT(frame.ground_from_geo(kPlace).norm(), 1e-6);
  const GeoPoint there = frame.geo_from_ground({300, -400});
  EXPECT_NEAR(geodesic_distance_m(kPlace, there), 500, 1e-3);
  EXPECT_NEAR(geodesic_azimuth_deg(kPlace, there), 143.13, 0.01);
  EXPECT_LT((frame.ground_from_geo(there) - Eigen::Vector2d(300, -400)).norm(), 1e-6);
}

// An image of kSide x kSide pixels about kPlace in Web Mercator. `fill` has the planes' values.
void write_image(const std::filesystem::path& file, const std::vector<GDALColorInterp>& bands,
                 const std::function<int(int band, int x, int y)>& fill,
                 GDALDataType type = GDT_Byte, bool georeferenced = true) {
  GDALAllRegister();
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const std::unique_ptr<GDALDataset> dataset(
      driver->Create(file.c_str(), kSide, kSide, static_cast<int>(bands.size()), type, nullptr));
  ASSERT_NE(dataset, nullptr);
  if (georeferenced) {
    const double x_m = 6378137 * kPlace.longitude_deg * kRadPerDeg;
    const double y_m = 6378137 * std::log(std::tan((45 + kPlace.latitude_deg / 2) * kRadPerDeg));
    double transform[6] = {x_m - kSide * kMercatorM / 2, kMercatorM, 0,
                           y_m + kSide * kMercatorM / 2, 0,          -kMercatorM};
    OGRSpatialReference reference;
    ASSERT_EQ(reference.importFromEPSG(3857), OGRERR_NONE);
    ASSERT_EQ(dataset->SetGeoTransform(transform), CE_None);
    ASSERT_EQ(dataset->SetSpatialRef(&reference), CE_None);
  }
  for (std::size_t i = 0; i < bands.size(); ++i) {
    GDALRasterBand* const band = dataset->GetRasterBand(static_cast<int>(i) + 1);
    ASSERT_EQ(band->SetColorInterpretation(bands[i]), CE_None);
    for (int y = 0; y < kSide; ++y) {
      std::vector<std::int32_t> row(kSide);
      for (int x = 0; x < kSide; ++x) row[x] = fill(static_cast<int>(i), x, y);
      ASSERT_EQ(band->RasterIO(GF_Write, 0, y, kSide, 1, row.data(), kSide, 1, GDT_Int32, 0, 0),
                CE_None);
    }
  }
}

const std::vector<GDALColorInterp> kRgb = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand};

cv::Vec3b middle_of(const Picture& picture) {
  return picture.bgr.at<cv::Vec3b>(picture.bgr.rows / 2, picture.bgr.cols / 2);
}

Picture read_all(const std::filesystem::path& file, double metres_per_pixel) {
  const Result<Orthoimage> image = Orthoimage::open({file, "", {}}, metres_per_pixel);
  EXPECT_TRUE(image.ok()) << image.error().line();
  const Result<Picture> picture = image->read(cv::Rect({0, 0}, image->size()));
  EXPECT_TRUE(picture.ok());
  return *picture;
}

std::string refusal(const std::filesystem::path& file) {
  const Result<Orthoimage> image = Orthoimage::open({file, "", {}}, 0.1);
  return image.ok() ? "" : image.error().line();
}

TEST(Orthoimage, PixelsAreMetresOnTheGround) {
  const TempFolder folder;
  write_image(folder / "a.tif", kRgb, [](int, int x, int) { return x < kSide / 2 ? 40 : 200; });
  const Picture picture = read_all(folder / "a.tif", 0.1);
  EXPECT_NEAR(picture.bgr.cols, 400, 4);
  EXPECT_NEAR(picture.bgr.rows, 400, 4);
  int first_bright = 0;
  while (picture.bgr.at<cv::Vec3b>(200, first_bright)[0] < 120) ++first_bright;
  EXPECT_NEAR(picture.grid.ground_from_pixel({first_bright - 0.5, 200}).x(), 0, 0.1);
}

TEST(Orthoimage, ABlockIsAPartOfTheWhole) {
  const TempFolder folder;
  write_image(folder / "a.tif", kRgb,
              [](int band, int x, int y) { return (x * 3 + y * 7 + band * 50) % 256; });
  const Picture whole = read_all(folder / "a.tif", 0.1);
  const Result<Orthoimage> image = Orthoimage::open({folder / "a.tif", "", {}}, 0.1);
  const cv::Rect block(130, 70, 90, 110);
  const Result<Picture> part = image->read(block);
  ASSERT_TRUE(part.ok());
  EXPECT_EQ(cv::norm(part->bgr, whole.bgr(block), cv::NORM_INF), 0);
  EXPECT_LT((part->grid.ground_from_pixel({3, 5}) - whole.grid.ground_from_pixel({133, 75})).norm(),
            1e-9);
  const Result<Picture> corner = image->read(cv::Rect(-20, -30, 50, 50));
  ASSERT_TRUE(corner.ok());
  EXPECT_EQ(cv::norm(corner->bgr, whole.bgr(cv::Rect(0, 0, 30, 20)), cv::NORM_INF), 0);
  EXPECT_EQ(corner->grid.west_m, whole.grid.west_m);
}

TEST(Orthoimage, BandsAreReadByWhatTheyShow) {
  const TempFolder folder;
  const auto fill = [](int band, int, int) { return 50 + 60 * band; };
  write_image(folder / "rgb.tif", kRgb, fill);
  EXPECT_EQ(middle_of(read_all(folder / "rgb.tif", 0.2)), cv::Vec3b(170, 110, 50));
  write_image(folder / "bgr.tif", {GCI_BlueBand, GCI_GreenBand, GCI_RedBand}, fill);
  EXPECT_EQ(middle_of(read_all(folder / "bgr.tif", 0.2)), cv::Vec3b(50, 110, 170));
  write_image(folder / "grey.tif", {GCI_GrayIndex}, fill);
  EXPECT_EQ(middle_of(read_all(folder / "grey.tif", 0.2)), cv::Vec3b(50, 50, 50));
}

TEST(Orthoimage, BandsWithoutANameAreRedGreenAndBlue) {
  const TempFolder folder;
  write_image(folder / "a.tif", {GCI_GrayIndex, GCI_Undefined, GCI_Undefined},
              [](int band, int, int) { return 50 + 60 * band; });
  EXPECT_EQ(middle_of(read_all(folder / "a.tif", 0.2)), cv::Vec3b(170, 110, 50));
}

TEST(Orthoimage, APaletteIsColours) {
  const TempFolder folder;
  const auto palette = std::make_unique<GDALColorTable>();
  const GDALColorEntry brick{190, 80, 60, 255};
  palette->SetColorEntry(7, &brick);
  write_image(folder / "a.tif", {GCI_PaletteIndex}, [](int, int, int) { return 7; });
  std::unique_ptr<GDALDataset>(
      GDALDataset::Open((folder / "a.tif").c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE))
      ->GetRasterBand(1)
      ->SetColorTable(palette.get());
  EXPECT_EQ(middle_of(read_all(folder / "a.tif", 0.2)), cv::Vec3b(60, 80, 190));
}

// Coordinates of EPSG:4326 are latitude and longitude by its definition, the other way in files.
TEST(Orthoimage, DegreesAreAReferenceToo) {
  const TempFolder folder;
  write_image(folder / "a.tif", kRgb, [](int, int, int) { return 90; });
  const std::unique_ptr<GDALDataset> dataset(
      GDALDataset::Open((folder / "a.tif").c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
  double transform[6] = {kPlace.longitude_deg - 2e-4, 4e-6, 0,
                         kPlace.latitude_deg + 1e-4,  0,    -2e-6};
  OGRSpatialReference reference;
  ASSERT_EQ(reference.importFromEPSG(4326), OGRERR_NONE);
  ASSERT_EQ(dataset->SetGeoTransform(transform), CE_None);
  ASSERT_EQ(dataset->SetSpatialRef(&reference), CE_None);
  dataset->FlushCache();
  const Result<Orthoimage> image = Orthoimage::open({folder / "a.tif", "", {}}, 0.2);
  ASSERT_TRUE(image.ok()) << image.error().line();
  const GeoPoint middle{kPlace.latitude_deg - 1e-4, kPlace.longitude_deg + 2e-4, 0};
  EXPECT_LT(geodesic_distance_m(image->frame().origin(), middle), 0.5);
  EXPECT_NEAR(image->size().width * 0.2, 800e-6 * 111320 * std::cos(60 * kRadPerDeg), 1);
}

TEST(Orthoimage, ItsBoundsAreThoseOfItsPixels) {
  const TempFolder folder;
  write_image(folder / "a.tif", kRgb, [](int, int, int) { return 90; });
  const Result<Orthoimage> image = Orthoimage::open({folder / "a.tif", "", {}}, 0.1);
  ASSERT_TRUE(image.ok());
  EXPECT_LT(geodesic_distance_m(image->frame().origin(), kPlace), 0.5);
  const Bounds bounds = image->bounds();
  const double half_deg = 20 / 111320.0;  // of latitude, for 20 m
  EXPECT_NEAR(bounds.south_deg, kPlace.latitude_deg - half_deg, 0.05 * half_deg);
  EXPECT_NEAR(bounds.north_deg, kPlace.latitude_deg + half_deg, 0.05 * half_deg);
  EXPECT_NEAR(bounds.west_deg, kPlace.longitude_deg - 2 * half_deg, 0.1 * half_deg);
  EXPECT_NEAR(bounds.east_deg, kPlace.longitude_deg + 2 * half_deg, 0.1 * half_deg);
}

TEST(Orthoimage, WhatLiesBetweenPixelsIsInterpolated) {
  const TempFolder folder;
  write_image(folder / "a.tif", kRgb, [](int, int x, int) { return x < 50 ? 4 * x : 200; });
  const Picture picture = read_all(folder / "a.tif", 0.1);
  for (int x = 20; x < 80; ++x) {  // 4 grey values each 0.2 m
    const auto& here = picture.bgr.at<cv::Vec3b>(200, x);
    EXPECT_NEAR(picture.bgr.at<cv::Vec3b>(200, x + 1)[0] - here[0], 2, 1) << x;
  }
}

TEST(Orthoimage, TransparencyAndNoDataAreGaps) {
  const TempFolder folder;
  const auto half_clear = [](int band, int x, int) {
    return band == 3 ? (x < kSide / 2 ? 0 : 255) : 90;
  };
  write_image(folder / "rgba.tif", {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_AlphaBand},
              half_clear);
  const cv::Mat covered = read_all(folder / "rgba.tif", 0.2).covered;
  EXPECT_EQ(covered.at<std::uint8_t>(100, 50), 0);
  EXPECT_EQ(covered.at<std::uint8_t>(100, 150), 255);

  write_image(folder / "grey.tif", {GCI_GrayIndex},
              [](int, int x, int) { return x < kSide / 2 ? 0 : 90; });
  std::unique_ptr<GDALDataset>(
      GDALDataset::Open((folder / "grey.tif").c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE))
      ->GetRasterBand(1)
      ->SetNoDataValue(0);
  const cv::Mat with_data = read_all(folder / "grey.tif", 0.2).covered;
  EXPECT_EQ(with_data.at<std::uint8_t>(100, 50), 0);
  EXPECT_EQ(with_data.at<std::uint8_t>(100, 150), 255);
}

TEST(Orthoimage, AWorldFileNeedsAReference) {
  const TempFolder folder;
  write_image(
      folder / "a.tif", kRgb, [](int, int, int) { return 90; }, GDT_Byte, false);
  std::ofstream(folder / "a.tfw") << "0.4\n0\n0\n-0.4\n1168854\n8399738\n";
  EXPECT_THAT(refusal(folder / "a.tif"), AllOf(HasSubstr("a.tif"), HasSubstr("--image-crs")));
  const Result<Orthoimage> image = Orthoimage::open({folder / "a.tif", "EPSG:3857", {}}, 0.1);
  ASSERT_TRUE(image.ok());
  EXPECT_NEAR(image->frame().origin().latitude_deg, 60, 0.01);
  EXPECT_FALSE(Orthoimage::open({folder / "a.tif", "EPSG:nothing", {}}, 0.1).ok());
}

TEST(Orthoimage, WhatCannotBeUsedIsRefused) {
  const TempFolder folder;
  EXPECT_THAT(refusal(folder / "missing.tif"), HasSubstr("no such file"));
  ASSERT_TRUE(write_text_file(folder / "text.tif", "not an image").ok());
  EXPECT_THAT(refusal(folder / "text.tif"), HasSubstr("not an image that can be read"));
  write_image(
      folder / "nowhere.tif", kRgb, [](int, int, int) { return 90; }, GDT_Byte, false);
  EXPECT_THAT(refusal(folder / "nowhere.tif"), HasSubstr("no georeference"));
  write_image(folder / "clear.tif", {GCI_AlphaBand}, [](int, int, int) { return 255; });
  EXPECT_THAT(refusal(folder / "clear.tif"), HasSubstr("no band of grey or colours"));
  write_image(
      folder / "deep.tif", kRgb, [](int, int, int) { return 900; }, GDT_UInt16);
  EXPECT_THAT(refusal(folder / "deep.tif"), AllOf(HasSubstr("band 1"), HasSubstr("UInt16")));
}

// An image of kSide x kSide pixels with these coordinates of its top left corner and its pixels'
// sides, its rows turned by `turn`.
std::filesystem::path placed(const TempFolder& folder, const std::string& reference,
                             const std::array<double, 6>& transform) {
  const std::filesystem::path file = folder / "placed.tif";
  write_image(
      file, kRgb, [](int, int x, int y) { return x < kSide / 2 ? 40 : 150 + y % 50; }, GDT_Byte,
      false);
  const std::unique_ptr<GDALDataset> dataset(
      GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
  OGRSpatialReference named;
  EXPECT_EQ(named.SetFromUserInput(reference.c_str()), OGRERR_NONE);
  std::array<double, 6> copy = transform;
  EXPECT_EQ(dataset->SetGeoTransform(copy.data()), CE_None);
  EXPECT_EQ(dataset->SetSpatialRef(&named), CE_None);
  return file;
}

constexpr double kWorldEdgeM = 20037508.342789244;  // of EPSG:3857, at longitude 180

TEST(Orthoimage, TooCoarsePixelsAreRefusedBeforeTheyAreRead) {
  const TempFolder folder;
  const std::string world = refusal(placed(folder, "EPSG:4326", {-180, 1.8, 0, 90, 0, -0.9}));
  EXPECT_THAT(world, AllOf(HasSubstr("in its middle"), HasSubstr("at most 1.2 m")));
  EXPECT_THAT(refusal(placed(folder, "EPSG:32633", {5e5, 10, 0, 5e6, 0, -10})),
              HasSubstr("is 10 m long"));
  EXPECT_THAT(refusal(placed(folder, "EPSG:32633", {5e5, 1.3, 0, 5e6, 0, -0.3})),
              HasSubstr("is 1.3 m long"));
  EXPECT_EQ(refusal(placed(folder, "EPSG:32633", {5e5, 1, 0, 5e6, 0, -1})), "");
  // In a map in degrees up to a pole, pixels are wide in the south only.
  EXPECT_THAT(refusal(placed(folder, "EPSG:4326", {8, 0.335, 0, 90, 0, -1e-5})),
              AllOf(HasSubstr("corner is 1.3 m long"), HasSubstr("at most 1.2 m")));
}

TEST(Orthoimage, ItMayGoAcross180) {
  const TempFolder folder;
  const double row_deg = 2e-6;
  for (const auto& [reference, transform] :
       std::vector<std::pair<std::string, std::array<double, 6>>>{
           {"EPSG:3857", {kWorldEdgeM - 20, 0.2, 0, 39135, 0, -0.2}},
           {"EPSG:3857", {-kWorldEdgeM - 10, 0.2, 0, 39135, 0, -0.2}},
           {"EPSG:4326", {180 - 3e-4, 2e-6, 0, -16.5, 0, -row_deg}},
           {"EPSG:4326", {180 - 1e-4, 2e-6, 0, -16.5, 0, -row_deg}},
           {"EPSG:4326", {-180 - 3e-4, 2e-6, 0, -16.5, 0, -row_deg}},
           {"EPSG:32760", {820260, 0.2, 0, 8173600, 0, -0.2}}}) {
    const Result<Orthoimage> image =
        Orthoimage::open({placed(folder, reference, transform), "", {}}, 0.2);
    ASSERT_TRUE(image.ok()) << image.error().line();
    const Result<Picture> picture = image->read(cv::Rect({0, 0}, image->size()));
    ASSERT_TRUE(picture.ok());
    EXPECT_LT(picture->bgr.cols, 260) << reference;
    EXPECT_GT(cv::countNonZero(picture->covered),
              0.85 * static_cast<double>(picture->covered.total()))
        << reference << " " << transform[0];
    const Bounds bounds = image->bounds();
    EXPECT_TRUE(bounds.is_valid());
    EXPECT_TRUE(bounds.crosses_180()) << reference << " " << transform[0];
    EXPECT_GT(bounds.west_deg, 179.99);
    EXPECT_LT(bounds.east_deg, -179.99);
  }
}

TEST(Orthoimage, AboutAPoleItsBoundsHaveAllLongitudes) {
  const TempFolder folder;
  const Result<Orthoimage> image =
      Orthoimage::open({placed(folder, "EPSG:3031", {-15, 0.2, 0, 12, 0, -0.2}), "", {}}, 0.2);
  ASSERT_TRUE(image.ok()) << image.error().line();
  EXPECT_LT(image->size().width, 400);
  const Bounds bounds = image->bounds();
  EXPECT_EQ(bounds.west_deg, -180);
  EXPECT_EQ(bounds.east_deg, 180);
  EXPECT_EQ(bounds.south_deg, -90);
  EXPECT_LT(bounds.north_deg, -89.999);
}

TEST(Orthoimage, GeoreferencesThatLeadNowhereAreRefused) {
  const TempFolder folder;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [reference, transform] :
       std::vector<std::pair<std::string, std::array<double, 6>>>{
           {"EPSG:3857", {1e9, 1, 0, 5e6, 0, -1}},
           {"EPSG:32633", {5e5, 0.2, 0.2, 5e6, 0.2, 0.2}},  // singular
           {"EPSG:32633", {5e5, 1e-9, 0, 5e6, 0, -1e-9}},
           {"EPSG:32633", {nan, 0.2, 0, 5e6, 0, -0.2}},
           {"EPSG:32633", {5e5, nan, 0, 5e6, 0, -0.2}},
           {"EPSG:32633", {1e300, 0.2, 0, 5e6, 0, -0.2}},
           {"EPSG:4326", {8, 2e-6, 0, 90.00001, 0, -2e-6}},
           {"EPSG:4326", {359.9999, 2e-6, 0, 49, 0, -2e-6}}}) {
    EXPECT_THAT(refusal(placed(folder, reference, transform)),
                AnyOf(HasSubstr("position on the Earth"), HasSubstr("no georeference")))
        << reference << " " << transform[0];
  }
}

TEST(Orthoimage, ATurnedOneIsAsLargeAsItsCornersAsk) {
  const TempFolder folder;
  const double side = 0.2 * std::sqrt(0.5);
  const Result<Orthoimage> image = Orthoimage::open(
      {placed(folder, "EPSG:32633", {5e5, side, side, 5e6, side, -side}), "", {}}, 0.2);
  ASSERT_TRUE(image.ok()) << image.error().line();
  EXPECT_NEAR(image->size().width, kSide * std::sqrt(2.0), 4);
  EXPECT_NEAR(image->size().height, kSide * std::sqrt(2.0), 4);
}

TEST(Orthoimage, FarFinerPixelsThanAskedForAreRefused) {
  const TempFolder folder;
  const auto file = placed(folder, "EPSG:32633", {5e5, 0.004, 0, 5e6, 0, -0.004});
  EXPECT_TRUE(Orthoimage::open({file, "", {}}, 0.1).ok());
  EXPECT_THAT(Orthoimage::open({file, "", {}}, 0.2).error().line(), HasSubstr("40 times finer"));
}

// The file itself is small: it holds no pixels.
TEST(Orthoimage, AFileOfHugeTilesIsRefused) {
  const TempFolder folder;
  GDALAllRegister();
  for (const int side : {20000, 256}) {
    const std::string across = "BLOCKXSIZE=" + std::to_string(side);
    const std::string down = "BLOCKYSIZE=" + std::to_string(side);
    CPLStringList options;
    for (const std::string& word : {std::string("TILED=YES"), across, down,
                                    std::string("SPARSE_OK=TRUE"), std::string("COMPRESS=LZW")}) {
      options.AddString(word.c_str());
    }
    const std::filesystem::path file = folder / (std::to_string(side) + ".tif");
    {
      const std::unique_ptr<GDALDataset> dataset(
          GetGDALDriverManager()->GetDriverByName("GTiff")->Create(file.c_str(), 20000, 20000, 1,
                                                                   GDT_Byte, options.List()));
      ASSERT_NE(dataset, nullptr);
      std::array<double, 6> transform{5e5, 0.1, 0, 5e6, 0, -0.1};
      OGRSpatialReference reference;
      ASSERT_EQ(reference.importFromEPSG(32633), OGRERR_NONE);
      ASSERT_EQ(dataset->SetGeoTransform(transform.data()), CE_None);
      ASSERT_EQ(dataset->SetSpatialRef(&reference), CE_None);
    }
    if (side == 256) {
      EXPECT_EQ(refusal(file), "");
    } else {
      EXPECT_THAT(refusal(file), HasSubstr("blocks of 20000 x 20000"));
    }
  }
}

// An image of colours with a fourth band, tagged as transparency, of these values.
std::filesystem::path with_alpha(const TempFolder& folder,
                                 const std::function<int(int x, int y)>& alpha) {
  const std::filesystem::path file = folder / "alpha.tif";
  write_image(file, {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_AlphaBand},
              [&](int band, int x, int y) { return band == 3 ? alpha(x, y) : 50 + 60 * band; });
  return file;
}

int distrusted(const std::filesystem::path& file) {
  const Result<Orthoimage> image = Orthoimage::open({file, "", {}}, 0.2);
  EXPECT_TRUE(image.ok());
  return image->bands().distrusted_alpha;
}

TEST(Orthoimage, MasksAreTrustedAndDataTaggedAsMasksAreNot) {
  const TempFolder folder;
  const auto infrared = [](int x, int y) { return 40 + (7 * x + 11 * y) % 170; };
  EXPECT_EQ(distrusted(with_alpha(folder, infrared)), 4);
  // With a border without data, as rotated images have.
  EXPECT_EQ(distrusted(with_alpha(
                folder, [&](int x, int y) { return std::abs(x - y) < 60 ? infrared(x, y) : 0; })),
            4);
  EXPECT_EQ(distrusted(with_alpha(folder, [](int, int) { return 255; })), 0);
  EXPECT_EQ(distrusted(with_alpha(folder, [](int, int) { return 0; })), 0);
  EXPECT_EQ(distrusted(with_alpha(folder, [](int x, int) { return x < 90 ? 255 : 0; })), 0);
  const auto feathered = [](int x, int y) {
    const int to_edge = std::min({x, y, kSide - 1 - x, kSide - 1 - y});
    return std::min(255, 12 * to_edge);
  };
  const auto file = with_alpha(folder, feathered);
  EXPECT_EQ(distrusted(file), 0);
  const cv::Mat covered = read_all(file, 0.2).covered;
  EXPECT_EQ(covered.at<std::uint8_t>(100, 4), 0);
  EXPECT_EQ(covered.at<std::uint8_t>(100, 100), 255);
}

TEST(Orthoimage, DistrustedTransparencyHidesNothing) {
  const TempFolder folder;
  const auto file = with_alpha(folder, [](int x, int y) { return 20 + (7 * x + 11 * y) % 80; });
  const Picture picture = read_all(file, 0.2);
  EXPECT_EQ(picture.covered.at<std::uint8_t>(100, 100), 255);
  EXPECT_EQ(middle_of(picture), cv::Vec3b(170, 110, 50));
}

Picture read_bands(const std::filesystem::path& file, const std::vector<int>& bands) {
  const Result<Orthoimage> image = Orthoimage::open({file, "", bands}, 0.2);
  EXPECT_TRUE(image.ok()) << image.error().line();
  return *image->read(cv::Rect({0, 0}, image->size()));
}

TEST(Orthoimage, BandsCanBeChosen) {
  const TempFolder folder;
  const auto file = with_alpha(folder, [](int x, int) { return x < kSide / 2 ? 255 : 0; });
  EXPECT_EQ(middle_of(read_bands(file, {3, 2, 1})), cv::Vec3b(50, 110, 170));
  EXPECT_EQ(middle_of(read_bands(file, {2})), cv::Vec3b(110, 110, 110));
  for (const auto& bands : {std::vector<int>{1, 2, 3}, {2}, {1, 2, 4}}) {
    const cv::Mat covered = read_bands(file, bands).covered;
    EXPECT_EQ(covered.at<std::uint8_t>(100, 50), 255);
    EXPECT_EQ(covered.at<std::uint8_t>(100, 150), 255);
  }
  for (const auto& bands : {std::vector<int>{1, 2, 3, 4}, {1, 4}}) {
    const cv::Mat covered = read_bands(file, bands).covered;
    EXPECT_EQ(covered.at<std::uint8_t>(100, 50), 255);
    EXPECT_EQ(covered.at<std::uint8_t>(100, 150), 0);
  }
  // A mask that is not tagged as one.
  write_image(folder / "five.tif", {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_Undefined},
              [](int band, int x, int) { return band < 3        ? 90
                                                : x < kSide / 2 ? 0
                                                                : 255; });
  EXPECT_EQ(read_bands(folder / "five.tif", {1, 2, 3, 4}).covered.at<std::uint8_t>(100, 50), 0);
  EXPECT_EQ(read_bands(folder / "five.tif", {1, 2, 3}).covered.at<std::uint8_t>(100, 50), 255);
}

TEST(Orthoimage, BandsThatAreNotThereAreRefused) {
  const TempFolder folder;
  const auto file = with_alpha(folder, [](int, int) { return 255; });
  const auto refused = [&](const std::vector<int>& bands) {
    const Result<Orthoimage> image = Orthoimage::open({file, "", bands}, 0.2);
    return image.ok() ? "" : image.error().line();
  };
  EXPECT_THAT(refused({1, 2, 7}), AllOf(HasSubstr("alpha.tif"), HasSubstr("no band 7, but 4")));
  EXPECT_THAT(refused({1, 9}), HasSubstr("no band 9"));
  EXPECT_THAT(refused({0, 1, 2}), HasSubstr("from 1"));
  EXPECT_THAT(refused({-1}), HasSubstr("from 1"));
  EXPECT_THAT(refused({1, 1, 2}), HasSubstr("twice"));
  EXPECT_THAT(refused({1, 2, 3, 4, 5}), HasSubstr("one to four"));
}

// A mask in addition to the bands, as GeoTIFFs may have it, applies to any choice of bands.
TEST(Orthoimage, TheFilesOwnMaskCounts) {
  const TempFolder folder;
  const std::filesystem::path file = folder / "a.tif";
  write_image(file, kRgb, [](int, int, int) { return 90; });
  {
    const std::unique_ptr<GDALDataset> dataset(
        GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
    ASSERT_EQ(dataset->CreateMaskBand(GMF_PER_DATASET), CE_None);
    std::vector<std::uint8_t> row(kSide, 255);
    std::fill_n(row.begin(), kSide / 2, std::uint8_t{0});
    for (int y = 0; y < kSide; ++y) {
      ASSERT_EQ(dataset->GetRasterBand(1)->GetMaskBand()->RasterIO(
                    GF_Write, 0, y, kSide, 1, row.data(), kSide, 1, GDT_Byte, 0, 0),
                CE_None);
    }
  }
  for (const auto& bands : {std::vector<int>{}, {1, 2, 3}, {2}}) {
    const cv::Mat covered = read_bands(file, bands).covered;
    EXPECT_EQ(covered.at<std::uint8_t>(100, 50), 0);
    EXPECT_EQ(covered.at<std::uint8_t>(100, 150), 255);
  }
}

TEST(Orthoimage, DamageIsTold) {
  const TempFolder folder;
  write_image(folder / "a.tif", kRgb, [](int, int x, int y) { return (x * y) % 256; });
  std::filesystem::resize_file(folder / "a.tif", 60000);
  const Result<Orthoimage> image = Orthoimage::open({folder / "a.tif", "", {}}, 0.1);
  if (!image.ok()) return;  // the missing part may be the file's directory
  const Result<Picture> picture = image->read(cv::Rect({0, 0}, image->size()));
  ASSERT_FALSE(picture.ok());
  EXPECT_EQ(picture.error().code, ErrorCode::corrupt);
  EXPECT_THAT(picture.error().line(), HasSubstr("a.tif"));
}

}  // namespace
}  // namespace milepost
