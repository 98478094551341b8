#include "mapper/import/coordinates.h"

#include <ogr_spatialref.h>

#include <cmath>

#include "mapper/geodata/gdal.h"

namespace milepost {
namespace {

constexpr const char* kWgs84 = "EPSG:4979";  // latitude, longitude, height above the ellipsoid

struct DestroyTransformation {
  void operator()(OGRCoordinateTransformation* transformation) const {
    OGRCoordinateTransformation::DestroyCT(transformation);
  }
};

}  // namespace

struct CoordinateTransform::Impl {
  std::string crs;
  std::unique_ptr<OGRCoordinateTransformation, DestroyTransformation> transformation;
};

CoordinateTransform::CoordinateTransform(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CoordinateTransform::~CoordinateTransform() = default;
CoordinateTransform::CoordinateTransform(CoordinateTransform&&) noexcept = default;
CoordinateTransform& CoordinateTransform::operator=(CoordinateTransform&&) noexcept = default;

Result<CoordinateTransform> CoordinateTransform::from(const std::string& crs) {
  const QuietGdal quiet;
  OGRSpatialReference source;
  OGRSpatialReference target;
  const bool is_known = source.SetFromUserInput(crs.c_str()) == OGRERR_NONE &&
                        target.SetFromUserInput(kWgs84) == OGRERR_NONE;
  if (!is_known) {
    return Error{ErrorCode::invalid_input, "--crs", "'" + crs + "' is no reference system",
                 "name one that PROJ knows, for example EPSG:25832"};
  }
  if (!source.IsGeocentric() && !source.IsCompound() && source.GetAxesCount() == 2)
    source.PromoteTo3D(nullptr);
  source.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  target.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  auto impl = std::make_unique<Impl>();
  impl->crs = crs;
  impl->transformation.reset(OGRCreateCoordinateTransformation(&source, &target));
  if (!impl->transformation) {
    return Error{ErrorCode::invalid_input, "--crs", "there is no way from '" + crs + "' to WGS84",
                 "install PROJ's grids (proj-data), or transform the coordinates before"};
  }
  return CoordinateTransform(std::move(impl));
}

Result<GeoPoint> CoordinateTransform::wgs84_of(double x, double y, double z) const {
  const QuietGdal quiet;
  int done = 0;
  const bool is_done = impl_->transformation->Transform(1, &x, &y, &z, &done) != 0 && done != 0;
  const GeoPoint position{y, x, z};
  if (is_done && is_valid(position) && std::isfinite(z)) return position;
  return Error{ErrorCode::invalid_input, "", "cannot be transformed from " + impl_->crs,
               "check the reference system and the order of the coordinates"};
}

}  // namespace milepost
