#include "tests/simulator/aerial.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "schema/base/file.h"
#include "tests/simulator/parallel.h"
#include "tests/simulator/sensors.h"

namespace milepost::simulator {
namespace fs = std::filesystem;
namespace {

constexpr double kFlightM = 500;    // of the plane in which the picture lies; above everything
constexpr double kExposure = 1.25;  // brightens streets in the shade of houses
constexpr int kStripRows = 256;
constexpr int kBlockColumns = 512;

Error cannot_write(const fs::path& path) {
  return {ErrorCode::io, path.string(),
          "cannot be written (" + std::string(CPLGetLastErrorMsg()) + ")",
          "check the path, the disk's space and the permissions"};
}

using Dataset = std::unique_ptr<GDALDataset, decltype(&GDALClose)>;

Dataset create(const fs::path& path, const cv::Size& size) {
  GDALAllRegister();
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const char* const options[] = {
      "COMPRESS=DEFLATE", "PREDICTOR=2",     "TILED=YES", "BLOCKXSIZE=256",
      "BLOCKYSIZE=256",   "PHOTOMETRIC=RGB", nullptr};
  CPLPushErrorHandler(CPLQuietErrorHandler);
  Dataset dataset(driver->Create(path.c_str(), size.width, size.height, 3, GDT_Byte,
                                 const_cast<char**>(options)),
                  &GDALClose);
  CPLPopErrorHandler();
  return dataset;
}

bool describe(GDALDataset& dataset, const OrthoPlan& plan, const Town& town, const Light& light) {
  double transform[6] = {plan.south_west[0], plan.pixel_m, 0, plan.north_east[1], 0, -plan.pixel_m};
  OGRSpatialReference grid;
  if (grid.importFromProj4(town_grid().c_str()) != OGRERR_NONE) return false;
  char text[200];
  std::snprintf(
      text, sizeof text, "simulated town of seed %llu; sun azimuth %.1f deg, elevation %.1f deg",
      static_cast<unsigned long long>(town.seed), light.sun_azimuth_deg, light.sun_elevation_deg);
  return dataset.SetGeoTransform(transform) == CE_None && dataset.SetSpatialRef(&grid) == CE_None &&
         dataset.SetMetadataItem("TIFFTAG_IMAGEDESCRIPTION", text) == CE_None;
}

// The picture of a rectangle of the orthoimage's pixels.
cv::Mat render_block(const Town& town, const Lighting& lighting, const OrthoPlan& plan,
                     const cv::Rect& block) {
  const Point origin(plan.south_west[0] + (block.x + 0.5) * plan.pixel_m,
                     plan.north_east[1] - (block.y + 0.5) * plan.pixel_m, kFlightM);
  const Projection down =
      Projection::parallel(origin, {1, 0, 0}, {0, -1, 0}, {0, 0, -1}, plan.pixel_m, block.size());
  return render(town.scene, lighting, down);
}

bool write_strip(GDALDataset& dataset, const cv::Mat& strip, int top) {
  cv::Mat rgb;
  cv::cvtColor(strip, rgb, cv::COLOR_BGR2RGB);
  rgb.convertTo(rgb, -1, kExposure);
  return dataset.RasterIO(GF_Write, 0, top, rgb.cols, rgb.rows, rgb.data, rgb.cols, rgb.rows,
                          GDT_Byte, 3, nullptr, 3, static_cast<GSpacing>(rgb.step[0]), 1,
                          nullptr) == CE_None;
}

// Frees textures that are not visible in strips further south.
void forget_north_of(const Town& town, double north_m) {
  for (const Surface& surface : town.scene.surfaces) {
    if (surface.centre[1] - surface.radius_m > north_m) surface.texture->forget();
  }
}

}  // namespace

std::string town_grid() {
  char text[160];
  std::snprintf(text, sizeof text,
                "+proj=tmerc +lat_0=%.10g +lon_0=%.10g +k=1 +x_0=0 +y_0=0 +ellps=WGS84 +units=m "
                "+no_defs",
                kOrigin.latitude_deg, kOrigin.longitude_deg);
  return text;
}

OrthoPlan ortho_of(const Network& network) { return {network.south_west, network.north_east}; }

Status write_orthoimage(const Town& town, const Lighting& lighting, const OrthoPlan& plan,
                        const fs::path& path, int threads, const Progress& progress) {
  const cv::Vec2d extent = plan.north_east - plan.south_west;
  const cv::Size size(static_cast<int>(std::lround(extent[0] / plan.pixel_m)),
                      static_cast<int>(std::lround(extent[1] / plan.pixel_m)));
  const fs::path partial = partial_path_for(path);
  Dataset dataset = create(partial, size);
  if (!dataset) return cannot_write(path);
  if (!describe(*dataset, plan, town, lighting.light)) return cannot_write(path);
  const int blocks = (size.width + kBlockColumns - 1) / kBlockColumns;
  for (int top = 0; top < size.height; top += kStripRows) {
    cv::Mat strip(std::min(kStripRows, size.height - top), size.width, CV_8UC3);
    const Status status =
        for_each_in_parallel(static_cast<std::size_t>(blocks), threads, {}, [&](std::size_t i) {
          const int left = static_cast<int>(i) * kBlockColumns;
          const cv::Rect block(left, top, std::min(kBlockColumns, size.width - left), strip.rows);
          render_block(town, lighting, plan, block)
              .copyTo(strip.colRange(left, left + block.width));
          return ok_status();
        });
    if (!status) return status;
    if (!write_strip(*dataset, strip, top)) return cannot_write(path);
    forget_north_of(town, plan.north_east[1] - (top + strip.rows) * plan.pixel_m);
    const auto done = static_cast<std::size_t>(top + strip.rows);
    if (progress && !progress(done, static_cast<std::size_t>(size.height))) {
      dataset.reset();
      std::error_code ignored;
      fs::remove(partial, ignored);
      return Error{ErrorCode::cancelled, path.string(), "stopped on request", ""};
    }
  }
  CPLErrorReset();
  dataset.reset();
  if (CPLGetLastErrorType() >= CE_Failure) return cannot_write(path);
  return publish_file(partial, path);
}

Status write_walls(const Town& town, const fs::path& path) {
  using Json = nlohmann::ordered_json;
  Json features = Json::array();
  const auto degrees = [](double value) { return std::round(value * 1e9) / 1e9; };
  for (const Building& building : town.buildings) {
    Json ring = Json::array();
    for (std::size_t i = 0; i <= building.footprint.size(); ++i) {
      const cv::Vec2d& corner = building.footprint[i % building.footprint.size()];
      const GeoPoint at = geo_from_point({corner[0], corner[1], 0});
      ring.push_back({degrees(at.longitude_deg), degrees(at.latitude_deg)});
    }
    features.push_back({{"type", "Feature"},
                        {"properties",
                         {{"height_m", std::round(building.height_m() * 100) / 100},
                          {"eaves_m", std::round(building.eaves_m * 100) / 100}}},
                        {"geometry", {{"type", "Polygon"}, {"coordinates", Json::array({ring})}}}});
  }
  const Json collection = {{"type", "FeatureCollection"}, {"features", features}};
  return write_text_file(path, collection.dump(1) + "\n");
}

}  // namespace milepost::simulator
