#include "mapper/geodata/datum_transform.h"

#include <cmath>
#include <string>

#include "mapper/geodata/proj.h"
#include "schema/base/digits.h"

namespace milepost {
namespace {

// The system of degrees and heights that has the datum's name.
ProjObject geographic_of(const ProjContext& context, const Datum& datum) {
  const PJ_TYPE type = PJ_TYPE_GEOGRAPHIC_3D_CRS;
  const std::unique_ptr<PJ_OBJ_LIST, DestroyProj> named(proj_create_from_name(
      context.get(), nullptr, datum.name.c_str(), &type, 1, /*approximateMatch=*/0, 1, nullptr));
  if (!named || proj_list_get_count(named.get()) == 0) return nullptr;
  return ProjObject(proj_list_get(context.get(), named.get(), 0));
}

// Whether places on a continent move in it.
bool is_dynamic(const ProjContext& context, const PJ* crs) {
  const ProjObject datum(proj_crs_get_datum_forced(context.get(), crs));
  return datum && proj_get_type(datum.get()) == PJ_TYPE_DYNAMIC_GEODETIC_REFERENCE_FRAME;
}

Error wrong(const std::string& what, const std::string& hint) {
  return {ErrorCode::invalid_input, "--to-datum", what, hint};
}

}  // namespace

struct DatumTransform::Impl {
  std::string way;  // "from A to B"
  double epoch = HUGE_VAL;
  ProjContext context = quiet_proj();
  ProjObject transformation = {};  // destroyed before its context
};

DatumTransform::DatumTransform(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
DatumTransform::~DatumTransform() = default;
DatumTransform::DatumTransform(DatumTransform&&) noexcept = default;
DatumTransform& DatumTransform::operator=(DatumTransform&&) noexcept = default;

Result<DatumTransform> DatumTransform::between(const Datum& from, const Datum& to) {
  auto impl = std::make_unique<Impl>();
  impl->way = "from " + from.text() + " to " + to.text();
  const ProjObject source = geographic_of(impl->context, from);
  const ProjObject target = geographic_of(impl->context, to);
  for (const auto& [crs, datum] : {std::pair{&source, &from}, {&target, &to}}) {
    if (*crs) continue;
    return wrong("'" + datum->name + "' is no datum",
                 "name one that PROJ knows, for example ETRF2000 or ITRF2014@2020.5");
  }
  const bool from_moves = is_dynamic(impl->context, source.get());
  const bool to_moves = is_dynamic(impl->context, target.get());
  const std::optional<double> epoch = from_moves && from.epoch ? from.epoch : to.epoch;
  if ((from_moves || to_moves) && !epoch) {
    return wrong("the way " + impl->way + " needs an epoch",
                 "name the year of the positions, for example ITRF2014@2020.5");
  }
  constexpr double kMaxYears = 0.5;
  const bool have_moved = from_moves && to_moves && from.epoch && to.epoch &&
                          std::abs(*from.epoch - *to.epoch) > kMaxYears;
  if (have_moved) {
    return wrong("places move " + impl->way + ", and it is not known how",
                 "transform to " + to.name + "@" + shortest(*from.epoch) +
                     ", or to a datum of the continent");
  }
  if (epoch) impl->epoch = *epoch;
  impl->transformation = transformation(impl->context, source.get(), target.get(), false);
  if (!impl->transformation)
    return wrong("there is no way " + impl->way, "transform the positions before");
  return DatumTransform(std::move(impl));
}

Result<GeoPoint> DatumTransform::transformed(const GeoPoint& position) const {
  constexpr double kLeastExactM = 0.2;
  PJ* transformation = impl_->transformation.get();
  proj_errno_reset(transformation);
  const PJ_COORD there = proj_trans(
      transformation, PJ_FWD,
      proj_coord(position.longitude_deg, position.latitude_deg, position.altitude_m, impl_->epoch));
  const GeoPoint moved{there.xyz.y, there.xyz.x, there.xyz.z};
  const bool is_done =
      proj_errno(transformation) == 0 && is_valid(moved) && std::isfinite(there.xyz.z);
  if (!is_done)
    return wrong("there is no way " + impl_->way + " there", "transform the positions before");
  const ProjObject used(proj_trans_get_last_used_operation(transformation));
  const double exact_m =
      used ? proj_coordoperation_get_accuracy(impl_->context.get(), used.get()) : -1;
  if (exact_m >= 0 && exact_m <= kLeastExactM) return moved;
  return wrong(
      "the way " + impl_->way + " is known " +
          (exact_m < 0 ? std::string("to nobody knows what") : "to " + shortest(exact_m) + " m") +
          " only",
      "name realizations: ETRF2000, not ETRS89; ITRF2014, not WGS 84");
}

}  // namespace milepost
