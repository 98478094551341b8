#include "mapper/geodata/coordinate_transform.h"

#include <cmath>

#include "mapper/geodata/proj.h"

namespace milepost {
namespace {

constexpr const char* kWgs84 = "EPSG:4979";  // degrees and heights

// Whether degrees on the system's ellipsoid can be taken for degrees on that of WGS84. GRS80
// differs by a tenth of a millimetre.
bool has_ellipsoid_of_wgs84(PJ_CONTEXT* context, const PJ* geodetic) {
  const ProjObject ellipsoid(proj_get_ellipsoid(context, geodetic));
  double semi_major_m = 0;
  double inverse_flattening = 0;
  const bool is_known =
      ellipsoid && proj_ellipsoid_get_parameters(context, ellipsoid.get(), &semi_major_m, nullptr,
                                                 nullptr, &inverse_flattening) != 0;
  return is_known && std::abs(semi_major_m - 6378137) < 0.1 &&
         std::abs(inverse_flattening - 298.25722) < 1e-4;
}

// Degrees and heights of the datum of a system.
ProjObject geographic_of_datum(PJ_CONTEXT* context, const PJ* geodetic) {
  const ProjObject datum(proj_crs_get_datum_forced(context, geodetic));
  const ProjObject degrees(proj_create_ellipsoidal_3D_cs(
      context, PJ_ELLPS3D_LATITUDE_LONGITUDE_HEIGHT, nullptr, 0, nullptr, 0));
  if (!datum || !degrees) return nullptr;
  return ProjObject(proj_create_geographic_crs_from_datum(context, proj_get_name(geodetic),
                                                          datum.get(), degrees.get()));
}

}  // namespace

struct CoordinateTransform::Impl {
  std::string crs;
  std::string datum;
  bool is_geocentric = false;
  ProjContext context = quiet_proj();
  ProjObject transformation = {};  // destroyed before its context
};

CoordinateTransform::CoordinateTransform(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CoordinateTransform::~CoordinateTransform() = default;
CoordinateTransform::CoordinateTransform(CoordinateTransform&&) noexcept = default;
CoordinateTransform& CoordinateTransform::operator=(CoordinateTransform&&) noexcept = default;

Result<CoordinateTransform> CoordinateTransform::from(const std::string& crs) {
  auto impl = std::make_unique<Impl>();
  impl->crs = crs;
  PJ_CONTEXT* context = impl->context.get();
  const ProjObject named(proj_create(context, crs.c_str()));
  const ProjObject geodetic(named ? proj_crs_get_geodetic_crs(context, named.get()) : nullptr);
  if (!geodetic) {
    return Error{ErrorCode::invalid_input, "--crs", "'" + crs + "' is no reference system",
                 "name one that PROJ knows, for example EPSG:25832"};
  }
  const ProjObject target = has_ellipsoid_of_wgs84(context, geodetic.get())
                                ? geographic_of_datum(context, geodetic.get())
                                : ProjObject(proj_create(context, kWgs84));
  if (target) impl->datum = proj_get_name(target.get());
  impl->is_geocentric = proj_get_type(named.get()) == PJ_TYPE_GEOCENTRIC_CRS;
  const bool has_heights =
      impl->is_geocentric || proj_get_type(named.get()) == PJ_TYPE_COMPOUND_CRS;
  const ProjObject source(has_heights ? proj_clone(context, named.get())
                                      : proj_crs_promote_to_3D(context, nullptr, named.get()));
  if (source && target)
    impl->transformation = transformation(impl->context, source.get(), target.get(), false);
  if (!impl->transformation) {
    return Error{ErrorCode::invalid_input, "--crs",
                 "there is no way from '" + crs + "' to degrees and heights of " + impl->datum,
                 "install PROJ's grids (proj-data), or transform the coordinates before"};
  }
  return CoordinateTransform(std::move(impl));
}

const std::string& CoordinateTransform::datum() const { return impl_->datum; }

bool CoordinateTransform::is_geocentric() const { return impl_->is_geocentric; }

Result<GeoPoint> CoordinateTransform::geographic_of(double x, double y, double z) const {
  const PJ_COORD there =
      proj_trans(impl_->transformation.get(), PJ_FWD, proj_coord(x, y, z, HUGE_VAL));
  const GeoPoint position{there.xyz.y, there.xyz.x, there.xyz.z};
  if (is_valid(position) && std::isfinite(there.xyz.z)) return position;
  return Error{ErrorCode::invalid_input, "", "cannot be transformed from " + impl_->crs,
               "check the reference system and the order of the coordinates"};
}

}  // namespace milepost
