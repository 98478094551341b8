#include "mapper/aerial/orthoimage.h"

#include <gdal_utils.h>

#include <string>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "mapper/aerial/image_ground.h"
#include "mapper/geodata/gdal.h"

namespace milepost {
namespace fs = std::filesystem;
namespace {

constexpr GIntBig kCacheBytes = 64 << 20;  // of GDAL's block cache
// Image pixels per picture pixel, along a side: the part of the image that GDAL reads at once grows
// with its square, to 420 MB.
constexpr double kMaxReduction = 40;
constexpr std::int64_t kMaxBlockBytes = 256 << 20;  // of a block of the file
constexpr double kOnePixelM = 1;                    // tolerance of a picture's sides, for rounding

// A virtual dataset of `source` made by one of GDAL's utilities (gdal_translate, gdalwarp).
Dataset translated(GDALDataset& source, const std::vector<std::string>& arguments) {
  CPLStringList list;
  for (const std::string& argument : arguments) list.AddString(argument.c_str());
  GDALTranslateOptions* const options = GDALTranslateOptionsNew(list.List(), nullptr);
  Dataset made(static_cast<GDALDataset*>(
                   GDALTranslate("", GDALDataset::ToHandle(&source), options, nullptr)),
               &GDALClose);
  GDALTranslateOptionsFree(options);
  return made;
}

Dataset warped(GDALDataset& source, const std::vector<std::string>& arguments) {
  CPLStringList list;
  for (const std::string& argument : arguments) list.AddString(argument.c_str());
  GDALWarpAppOptions* const options = GDALWarpAppOptionsNew(list.List(), nullptr);
  GDALDatasetH sources[] = {GDALDataset::ToHandle(&source)};
  Dataset made(static_cast<GDALDataset*>(GDALWarp("", nullptr, 1, sources, options, nullptr)),
               &GDALClose);
  GDALWarpAppOptionsFree(options);
  return made;
}

// Whether the image's own alpha band is another one than the one to be used.
bool has_other_alpha(GDALDataset& image, const ImageBands& bands) {
  if ((image.GetRasterBand(bands.shown.front())->GetMaskFlags() & GMF_ALPHA) == 0) return false;
  return bands.alpha == 0 ||
         image.GetRasterBand(bands.alpha)->GetColorInterpretation() != GCI_AlphaBand;
}

// The colour or grey bands and the transparency of the image, in this order.
Dataset shown_bands(GDALDataset& image, const ImageBands& bands) {
  std::vector<std::string> arguments = {"-of", "VRT"};
  for (const int band : bands.shown)
    arguments.insert(arguments.end(), {"-b", std::to_string(band)});
  const bool is_grey = bands.shown.size() == 1;
  if (is_grey && image.GetRasterBand(bands.shown.front())->GetColorTable() != nullptr) {
    arguments.insert(arguments.end(), {"-expand", "rgb"});
    return translated(image, arguments);
  }
  std::string meaning = is_grey ? "gray" : "red,green,blue";
  if (bands.alpha != 0) {
    arguments.insert(arguments.end(), {"-b", std::to_string(bands.alpha)});
    meaning += ",alpha";
  }
  arguments.insert(arguments.end(), {"-colorinterp", meaning});
  if (has_other_alpha(image, bands)) arguments.insert(arguments.end(), {"-mask", "none"});
  return translated(image, arguments);
}

// Checks that any part of the image can be read in bounded memory.
Status check_cost(GDALDataset& image, const ImageBands& bands, const ImageGround& ground,
                  double metres_per_pixel, const fs::path& file) {
  if (metres_per_pixel > kMaxReduction * ground.finest_pixel_m) {
    return Error{ErrorCode::invalid_input, file.string(),
                 "its pixels are more than 40 times finer than the working resolution",
                 "make them coarser (gdalwarp -r average -tr 0.02 0.02)"};
  }
  int width = 0;
  int height = 0;
  image.GetRasterBand(bands.shown.front())->GetBlockSize(&width, &height);
  if (std::int64_t{width} * height * image.GetRasterCount() > kMaxBlockBytes) {
    return Error{ErrorCode::invalid_input, file.string(),
                 "it can only be read in blocks of " + std::to_string(width) + " x " +
                     std::to_string(height) + " pixels, too large to read in bounded memory",
                 "write it in tiles (gdal_translate -co TILED=YES)"};
  }
  return ok_status();
}

// Whether the picture has the size that the image's corners require.
bool is_of_size(GDALDataset& picture, double metres_per_pixel) {
  const double limit_m = 2 * kMaxReachM + kOnePixelM;
  return picture.GetRasterXSize() * metres_per_pixel <= limit_m &&
         picture.GetRasterYSize() * metres_per_pixel <= limit_m;
}

}  // namespace

struct Orthoimage::Impl {
  fs::path file;
  ImageBands bands;
  GroundFrame frame;
  double metres_per_pixel = 0;
  Dataset source{nullptr, &GDALClose};  // closed last: the others refer to it
  Dataset shown{nullptr, &GDALClose};
  Dataset picture{nullptr, &GDALClose};  // the last band is its transparency
  double west_m = 0;
  double north_m = 0;
};

Orthoimage::Orthoimage(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Orthoimage::Orthoimage(Orthoimage&&) noexcept = default;
Orthoimage& Orthoimage::operator=(Orthoimage&&) noexcept = default;
Orthoimage::~Orthoimage() = default;

Result<Orthoimage> Orthoimage::open(const ImageSource& from, double metres_per_pixel) {
  const fs::path& file = from.file;
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
  const Result<ImageGround> ground = ground_of(*source, from.reference, file);
  if (!ground) return ground.error();
  const Result<ImageBands> bands =
      from.bands.empty() ? bands_by_tags(*source, file) : bands_named(from.bands);
  if (!bands) return bands.error();
  Status status = check_bands(*source, *bands, file);
  if (status.ok()) status = check_cost(*source, *bands, *ground, metres_per_pixel, file);
  if (!status.ok()) return status.error();

  auto impl =
      std::make_unique<Impl>(Impl{file, *bands, GroundFrame(ground->middle), metres_per_pixel});
  impl->shown = shown_bands(*source, *bands);
  impl->source = std::move(source);
  if (impl->shown != nullptr) {
    const std::string grid = impl->frame.proj() + (ground->goes_beyond_180 ? " +over" : "");
    const std::string pixel = std::to_string(metres_per_pixel);
    impl->picture = warped(*impl->shown, {"-of", "VRT", "-s_srs", ground->reference, "-t_srs", grid,
                                          "-tr", pixel, pixel, "-r", "cubic", "-dstalpha"});
  }
  if (impl->picture == nullptr || !is_of_size(*impl->picture, metres_per_pixel)) {
    return Error{ErrorCode::invalid_input, file.string(),
                 "it cannot be resampled to the ground" + QuietGdal::in_brackets(),
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

const ImageBands& Orthoimage::bands() const { return impl_->bands; }

Bounds Orthoimage::bounds() const {
  const double east_m = impl_->west_m + size().width * impl_->metres_per_pixel;
  const double south_m = impl_->north_m - size().height * impl_->metres_per_pixel;
  return frame().bounds_of({impl_->west_m, south_m}, {east_m, impl_->north_m});
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
                   "it cannot be read completely" + QuietGdal::in_brackets(),
                   "fetch the image again"};
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
