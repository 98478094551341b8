#include "mapper/aerial/orthoimage.h"

#include <gdal_priv.h>
#include <gdal_utils.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace milepost {
namespace fs = std::filesystem;
namespace {

constexpr GIntBig kCacheBytes = 64 << 20;  // what GDAL may keep of all that it has read

using Dataset = std::unique_ptr<GDALDataset, decltype(&GDALClose)>;

// While it lives GDAL says nothing on standard error; its last message is kept.
class QuietGdal {
 public:
  QuietGdal() {
    CPLPushErrorHandler(CPLQuietErrorHandler);
    CPLErrorReset();
  }
  ~QuietGdal() { CPLPopErrorHandler(); }
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;

  // " (MESSAGE)", or nothing where there was none.
  static std::string in_brackets() {
    std::string text = CPLGetLastErrorMsg();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.empty() ? text : " (" + text + ")";
  }
};

// Bands of a dataset by what they show, counted from 1.
struct Bands {
  std::vector<int> shown;  // one (grey or a palette) or three (red, green, blue)
  int alpha = 0;           // 0: none
  bool palette = false;
};

Bands bands_of(GDALDataset& dataset) {
  Bands bands;
  std::array<int, 3> rgb{};
  std::vector<int> opaque;
  for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
    const GDALColorInterp shows = dataset.GetRasterBand(i)->GetColorInterpretation();
    if (shows == GCI_AlphaBand) {
      bands.alpha = i;
      continue;
    }
    opaque.push_back(i);
    if (shows >= GCI_RedBand && shows <= GCI_BlueBand) rgb.at(shows - GCI_RedBand) = i;
  }
  if (rgb[0] != 0 && rgb[1] != 0 && rgb[2] != 0) {
    bands.shown.assign(rgb.begin(), rgb.end());
  } else if (opaque.size() >= 3) {
    bands.shown.assign(opaque.begin(), opaque.begin() + 3);
  } else if (!opaque.empty()) {
    bands.shown = {opaque.front()};
    bands.palette = dataset.GetRasterBand(opaque.front())->GetColorTable() != nullptr;
  }
  return bands;
}

// A virtual dataset of `source` made by one of GDAL's utilities (gdal_translate, gdalwarp).
Dataset translated(GDALDataset& source, const std::vector<std::string>& words) {
  CPLStringList list;
  for (const std::string& word : words) list.AddString(word.c_str());
  GDALTranslateOptions* const options = GDALTranslateOptionsNew(list.List(), nullptr);
  Dataset made(static_cast<GDALDataset*>(
                   GDALTranslate("", GDALDataset::ToHandle(&source), options, nullptr)),
               &GDALClose);
  GDALTranslateOptionsFree(options);
  return made;
}

Dataset warped(GDALDataset& source, const std::vector<std::string>& words) {
  CPLStringList list;
  for (const std::string& word : words) list.AddString(word.c_str());
  GDALWarpAppOptions* const options = GDALWarpAppOptionsNew(list.List(), nullptr);
  GDALDatasetH sources[] = {GDALDataset::ToHandle(&source)};
  Dataset made(static_cast<GDALDataset*>(GDALWarp("", nullptr, 1, sources, options, nullptr)),
               &GDALClose);
  GDALWarpAppOptionsFree(options);
  return made;
}

// The colours, or the grey, and the transparency of the image, in this order.
Dataset shown_bands(GDALDataset& source, const Bands& bands) {
  std::vector<std::string> words = {"-of", "VRT"};
  for (const int band : bands.shown) words.insert(words.end(), {"-b", std::to_string(band)});
  if (bands.palette) {
    words.insert(words.end(), {"-expand", "rgb"});
  } else if (bands.alpha != 0) {
    words.insert(words.end(), {"-b", std::to_string(bands.alpha)});
  }
  return translated(source, words);
}

// What the image's coordinates are. Errors: invalid_input.
Result<OGRSpatialReference> reference_of(GDALDataset& dataset, const std::string& given,
                                         const fs::path& file) {
  OGRSpatialReference reference;
  if (const OGRSpatialReference* const own = dataset.GetSpatialRef(); own != nullptr) {
    reference = *own;
  } else if (given.empty()) {
    return Error{ErrorCode::invalid_input, file.string(), "the image has no georeference",
                 "say what its coordinates are (--image-crs EPSG:CODE), or give a GeoTIFF"};
  } else if (reference.SetFromUserInput(given.c_str()) != OGRERR_NONE) {
    return Error{ErrorCode::invalid_input, "--image-crs " + given, "no such reference is known",
                 "give one as EPSG:3857"};
  }
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

// The middle of the image. Errors: invalid_input (the georeference leads nowhere on the Earth).
Result<GeoPoint> middle_of(GDALDataset& dataset, const OGRSpatialReference& reference,
                           const fs::path& file) {
  double transform[6];
  if (dataset.GetGeoTransform(transform) != CE_None) {
    return Error{ErrorCode::invalid_input, file.string(), "the image has no georeference",
                 "give a GeoTIFF, or put a world file beside the image"};
  }
  OGRSpatialReference wgs84;
  wgs84.SetWellKnownGeogCS("WGS84");
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> to_wgs84(
      OGRCreateCoordinateTransformation(&reference, &wgs84));
  const double column = dataset.GetRasterXSize() / 2.0;
  const double row = dataset.GetRasterYSize() / 2.0;
  double x = transform[0] + column * transform[1] + row * transform[2];
  double y = transform[3] + column * transform[4] + row * transform[5];
  if (to_wgs84 == nullptr || !to_wgs84->Transform(1, &x, &y) || !is_valid(GeoPoint{y, x, 0})) {
    return Error{ErrorCode::invalid_input, file.string(),
                 "its georeference does not lead to a place on the Earth",
                 "correct it (gdal_edit.py -a_srs EPSG:CODE)"};
  }
  return GeoPoint{y, x, 0};
}

std::string wkt_of(const OGRSpatialReference& reference) {
  char* text = nullptr;
  reference.exportToWkt(&text);
  std::string wkt = text;
  CPLFree(text);
  return wkt;
}

Status check_pixels(GDALDataset& dataset, const Bands& bands, const fs::path& file) {
  if (bands.shown.empty()) {
    return Error{ErrorCode::invalid_input, file.string(), "it has no band of grey or colours",
                 "give an image of one band, or of red, green and blue"};
  }
  for (const int band : bands.shown) {
    const GDALDataType type = dataset.GetRasterBand(band)->GetRasterDataType();
    if (type == GDT_Byte) continue;
    return Error{ErrorCode::invalid_input, file.string() + ", band " + std::to_string(band),
                 std::string("its values are ") + GDALGetDataTypeName(type) + ", not bytes",
                 "convert it (gdal_translate -ot Byte -scale)"};
  }
  return ok_status();
}

}  // namespace

struct Orthoimage::Impl {
  fs::path file;
  GroundFrame frame;
  double metres_per_pixel = 0;
  Dataset source{nullptr, &GDALClose};  // closed last: the others read it
  Dataset shown{nullptr, &GDALClose};
  Dataset picture{nullptr, &GDALClose};  // the last band is its transparency
  double west_m = 0;
  double north_m = 0;
};

Orthoimage::Orthoimage(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Orthoimage::Orthoimage(Orthoimage&&) noexcept = default;
Orthoimage& Orthoimage::operator=(Orthoimage&&) noexcept = default;
Orthoimage::~Orthoimage() = default;

Result<Orthoimage> Orthoimage::open(const fs::path& file, const std::string& reference,
                                    double metres_per_pixel) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) {
    return Error{ErrorCode::not_found, file.string(), "there is no such file", "check the path"};
  }
  GDALAllRegister();
  GDALSetCacheMax64(kCacheBytes);
  const QuietGdal quiet;
  Dataset source(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY), &GDALClose);
  if (source == nullptr) {
    return Error{ErrorCode::invalid_input, file.string(),
                 "it is not an image that can be read" + QuietGdal::in_brackets(),
                 "give a GeoTIFF, or an image with a world file"};
  }
  const Bands bands = bands_of(*source);
  if (const Status status = check_pixels(*source, bands, file); !status) return status.error();
  const Result<OGRSpatialReference> own = reference_of(*source, reference, file);
  if (!own) return own.error();
  const Result<GeoPoint> middle = middle_of(*source, *own, file);
  if (!middle) return middle.error();

  auto impl = std::make_unique<Impl>(Impl{file, GroundFrame(*middle), metres_per_pixel});
  impl->shown = shown_bands(*source, bands);
  impl->source = std::move(source);
  if (impl->shown != nullptr) {
    const std::string pixel = std::to_string(metres_per_pixel);
    impl->picture =
        warped(*impl->shown, {"-of", "VRT", "-s_srs", wkt_of(*own), "-t_srs", impl->frame.proj(),
                              "-tr", pixel, pixel, "-r", "cubic", "-dstalpha"});
  }
  if (impl->picture == nullptr) {
    return Error{ErrorCode::invalid_input, file.string(),
                 "it cannot be brought to the ground" + QuietGdal::in_brackets(),
                 "check its georeference"};
  }
  double transform[6];
  impl->picture->GetGeoTransform(transform);
  impl->west_m = transform[0];
  impl->north_m = transform[3];
  return Orthoimage(std::move(impl));
}

cv::Size Orthoimage::size() const {
  return {impl_->picture->GetRasterXSize(), impl_->picture->GetRasterYSize()};
}

const GroundFrame& Orthoimage::frame() const { return impl_->frame; }

Bounds Orthoimage::bounds() const {
  const double east_m = impl_->west_m + size().width * impl_->metres_per_pixel;
  const double south_m = impl_->north_m - size().height * impl_->metres_per_pixel;
  Bounds bounds{180, 90, -180, -90};
  for (const double x_m : {impl_->west_m, east_m}) {
    for (const double y_m : {south_m, impl_->north_m}) {
      const GeoPoint corner = frame().geo_from_ground({x_m, y_m});
      bounds = bounds.joined(
          {corner.longitude_deg, corner.latitude_deg, corner.longitude_deg, corner.latitude_deg});
    }
  }
  return bounds;
}

Result<Picture> Orthoimage::read(const cv::Rect& block) const {
  const cv::Rect inside = block & cv::Rect({0, 0}, size());
  const int bands = impl_->picture->GetRasterCount();
  std::vector<cv::Mat> planes;
  const QuietGdal quiet;
  for (int band = 1; band <= bands; ++band) {
    cv::Mat plane(inside.size(), CV_8UC1);
    if (impl_->picture->GetRasterBand(band)->RasterIO(
            GF_Read, inside.x, inside.y, inside.width, inside.height, plane.data, plane.cols,
            plane.rows, GDT_Byte, 1, static_cast<GSpacing>(plane.step[0]), nullptr) != CE_None) {
      return Error{ErrorCode::corrupt, impl_->file.string(),
                   "it cannot be read through" + QuietGdal::in_brackets(), "fetch the image anew"};
    }
    planes.push_back(std::move(plane));
  }
  Picture picture;
  picture.covered = planes.back() > 127;
  if (bands >= 4) {
    cv::merge(std::vector<cv::Mat>{planes[2], planes[1], planes[0]}, picture.bgr);
  } else {
    cv::cvtColor(planes.front(), picture.bgr, cv::COLOR_GRAY2BGR);
  }
  picture.grid = {impl_->west_m + inside.x * impl_->metres_per_pixel,
                  impl_->north_m - inside.y * impl_->metres_per_pixel, impl_->metres_per_pixel};
  return picture;
}

}  // namespace milepost
