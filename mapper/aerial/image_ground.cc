#include "mapper/aerial/image_ground.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include <Eigen/Geometry>

namespace milepost {
namespace fs = std::filesystem;
namespace {

constexpr double kLeastPixelM = 1e-4;
constexpr const char* kGoOnBeyond180 = " +over";  // a PROJ parameter
constexpr double kLeastShape = 0.05;  // of a pixel: its area relative to a rectangle with its sides

Result<OGRSpatialReference> reference_of(GDALDataset& image, const std::string& given,
                                         const fs::path& file) {
  OGRSpatialReference reference;
  if (const OGRSpatialReference* const own = image.GetSpatialRef(); own != nullptr) {
    reference = *own;
  } else if (given.empty()) {
    return Error{
        ErrorCode::invalid_input, file.string(), "the image has no georeference",
        "state its coordinate reference system (--image-crs EPSG:CODE), or give a GeoTIFF"};
  } else if (reference.SetFromUserInput(given.c_str()) != OGRERR_NONE) {
    return Error{ErrorCode::invalid_input, "--image-crs " + given,
                 "unknown coordinate reference system", "give one as EPSG:3857"};
  }
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

std::string wkt_of(const OGRSpatialReference& reference) {
  char* text = nullptr;
  reference.exportToWkt(&text);
  std::string wkt = text;
  CPLFree(text);
  return wkt;
}

// Metres, to two significant digits below 100 m, else whole: 1.2 m, 10 m, 78271 m.
std::string in_metres(double metres) {
  std::ostringstream text;
  if (metres < 100) {
    text << std::setprecision(2) << metres << " m";
  } else {
    text << std::fixed << std::setprecision(0) << metres << " m";
  }
  return text.str();
}

// A point in the image, in pixels from its top left corner.
struct PixelPlace {
  std::string name;  // "in the middle"
  double column = 0;
  double row = 0;
  int inward = 1;  // the sign of a step along columns and
  int down = 1;    // along rows that stays in the image
};

struct PixelSides {
  double column_m = 0;  // of one pixel, on the ground
  double row_m = 0;
  double shape = 0;  // of its corner: 1 for a right angle, 0 if degenerate

  double coarse_m() const { return std::max(column_m, row_m); }
  double fine_m() const { return std::min(column_m, row_m); }
};

using Transformation = std::unique_ptr<OGRCoordinateTransformation>;

OGRSpatialReference wgs84() {
  OGRSpatialReference reference;
  reference.SetWellKnownGeogCS("WGS84");
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

// The same reference system without wrapping of longitudes at 180 degrees.
std::string going_on_beyond_180(const OGRSpatialReference& reference) {
  char* text = nullptr;
  reference.exportToProj4(&text);
  std::string proj = text;
  CPLFree(text);
  return proj + kGoOnBeyond180;
}

class GroundSurvey {
 public:
  // Errors: invalid_input (no georeference).
  static Result<GroundSurvey> of(GDALDataset& image, const OGRSpatialReference& reference,
                                 const fs::path& file) {
    GroundSurvey survey(image, reference, file);
    if (image.GetGeoTransform(survey.transform_.data()) == CE_None) return survey;
    return Error{ErrorCode::invalid_input, file.string(), "the image has no georeference",
                 "give a GeoTIFF, or put a world file beside the image"};
  }

  // Whether each corner's coordinates survive the round trip over its position on the Earth; those
  // beyond the edge of a world map do not. Degrees may always exceed 180.
  bool is_within_reference() const {
    if (is_geographic_) return true;
    for (const PixelPlace& corner : corners()) {
      const auto [x, y] = coordinates_of(corner.column, corner.row);
      double again_x = x;
      double again_y = y;
      const bool is_on_earth = to_wgs84_ != nullptr && from_wgs84_ != nullptr &&
                               to_wgs84_->Transform(1, &again_x, &again_y) != 0;
      if (!is_on_earth) return true;  // check() reports it
      if (from_wgs84_->Transform(1, &again_x, &again_y) == 0) return false;
      if (std::hypot(again_x - x, again_y - y) > kMaxReachM) return false;
    }
    return true;
  }

  // Errors: as ground_of.
  Result<ImageGround> check(const std::string& reference) const {
    ImageGround ground;
    ground.reference = reference;
    Status status = survey_middle(ground);
    for (const PixelPlace& corner : corners()) {
      if (status.ok()) status = check_corner(corner, ground);
    }
    if (!status.ok()) return status.error();
    return ground;
  }

 private:
  GroundSurvey(GDALDataset& image, const OGRSpatialReference& reference, const fs::path& file)
      : file_(file),
        width_(image.GetRasterXSize()),
        height_(image.GetRasterYSize()),
        is_geographic_(reference.IsGeographic() != 0) {
    const OGRSpatialReference earth = wgs84();
    to_wgs84_.reset(OGRCreateCoordinateTransformation(&reference, &earth));
    from_wgs84_.reset(OGRCreateCoordinateTransformation(&earth, &reference));
  }

  std::array<PixelPlace, 4> corners() const {
    return {PixelPlace{"at its top left corner", 0, 0, 1, 1},
            PixelPlace{"at its top right corner", width_, 0, -1, 1},
            PixelPlace{"at its bottom left corner", 0, height_, 1, -1},
            PixelPlace{"at its bottom right corner", width_, height_, -1, -1}};
  }

  Status survey_middle(ImageGround& ground) const {
    const PixelPlace middle{"in its middle", width_ / 2, height_ / 2, 1, 1};
    const std::optional<GeoPoint> at = geo_from_pixel(middle.column, middle.row);
    const std::optional<PixelSides> sides = at ? sides_at(middle, *at) : std::nullopt;
    const bool has_area = sides && sides->fine_m() >= kLeastPixelM && sides->shape >= kLeastShape;
    if (!has_area) return leads_nowhere(middle);
    if (sides->coarse_m() > kCoarsestPixelM) return too_coarse(middle, *sides);
    ground.middle = *at;
    ground.finest_pixel_m = sides->fine_m();
    return ok_status();
  }

  Status check_corner(const PixelPlace& corner, const ImageGround& ground) const {
    const std::optional<GeoPoint> at = geo_from_pixel(corner.column, corner.row);
    const std::optional<PixelSides> sides = at ? sides_at(corner, *at) : std::nullopt;
    if (!sides) return leads_nowhere(corner);
    if (sides->coarse_m() > kCoarsestPixelM) return too_coarse(corner, *sides);
    const double reach_m = geodesic_distance_m(ground.middle, *at);
    if (reach_m > kMaxReachM) return too_large(reach_m);
    return ok_status();
  }

  std::pair<double, double> coordinates_of(double column, double row) const {
    return {transform_[0] + column * transform_[1] + row * transform_[2],
            transform_[3] + column * transform_[4] + row * transform_[5]};
  }

  // The position of a pixel on the Earth, if it has one.
  std::optional<GeoPoint> geo_from_pixel(double column, double row) const {
    auto [x, y] = coordinates_of(column, row);
    if (to_wgs84_ == nullptr || !to_wgs84_->Transform(1, &x, &y)) return std::nullopt;
    if (!(std::abs(x) <= 360)) return std::nullopt;
    const GeoPoint point{y, std::remainder(x, 360.0), 0};
    return is_valid(point) ? std::optional(point) : std::nullopt;
  }

  std::optional<PixelSides> sides_at(const PixelPlace& place, const GeoPoint& at) const {
    const auto beside = geo_from_pixel(place.column + place.inward, place.row);
    const auto below = geo_from_pixel(place.column, place.row + place.down);
    if (!beside || !below) return std::nullopt;
    const LocalFrame frame(at);
    const EnuPoint a = frame.enu_from_geo(*beside);
    const EnuPoint b = frame.enu_from_geo(*below);
    const Eigen::Vector3d column(a.east_m, a.north_m, a.up_m);
    const Eigen::Vector3d row(b.east_m, b.north_m, b.up_m);
    const double rectangle_m2 = column.norm() * row.norm();
    return PixelSides{column.norm(), row.norm(),
                      rectangle_m2 > 0 ? column.cross(row).norm() / rectangle_m2 : 0};
  }

  Error leads_nowhere(const PixelPlace& place) const {
    return {ErrorCode::invalid_input, file_.string(),
            "its georeference gives no position on the Earth " + place.name,
            "correct it (gdal_edit.py -a_srs EPSG:CODE)"};
  }

  Error too_coarse(const PixelPlace& place, const PixelSides& sides) const {
    return {ErrorCode::invalid_input, file_.string(),
            "a pixel " + place.name + " is " + in_metres(sides.coarse_m()) +
                " long on the ground, and walls are visible in pixels of at most " +
                in_metres(kCoarsestPixelM),
            "give a finer image"};
  }

  Error too_large(double reach_m) const {
    return {ErrorCode::invalid_input, file_.string(),
            "it reaches " + in_metres(reach_m) + " from its middle to a corner, more than " +
                in_metres(kMaxReachM),
            "extract a part of it (gdal_translate -projwin)"};
  }

  const fs::path& file_;
  double width_ = 0;  // in pixels
  double height_ = 0;
  bool is_geographic_ = false;
  std::array<double, 6> transform_{};
  Transformation to_wgs84_;
  Transformation from_wgs84_;
};

}  // namespace

Result<ImageGround> ground_of(GDALDataset& image, const std::string& reference,
                              const fs::path& file) {
  Result<OGRSpatialReference> own = reference_of(image, reference, file);
  if (!own) return own.error();
  const Result<GroundSurvey> survey = GroundSurvey::of(image, *own, file);
  if (!survey) return survey.error();
  if (survey->is_within_reference()) return survey->check(wkt_of(*own));

  const std::string beyond = going_on_beyond_180(*own);
  own->SetFromUserInput(beyond.c_str());
  own->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const Result<GroundSurvey> again = GroundSurvey::of(image, *own, file);
  if (!again) return again.error();
  Result<ImageGround> ground = again->check(beyond);
  if (ground) ground->goes_beyond_180 = true;
  return ground;
}

}  // namespace milepost
