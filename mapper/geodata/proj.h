// Objects of PROJ.
#pragma once

#include <proj.h>
#include <proj_experimental.h>  // systems with heights

#include <memory>
#include <string>

namespace milepost {

struct DestroyProj {
  void operator()(PJ* object) const { proj_destroy(object); }
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
  void operator()(PJ_OBJ_LIST* list) const { proj_list_destroy(list); }
};

using ProjContext = std::unique_ptr<PJ_CONTEXT, DestroyProj>;
using ProjObject = std::unique_ptr<PJ, DestroyProj>;

// Tells errors to the caller only.
inline ProjContext quiet_proj() {
  ProjContext context(proj_context_create());
  proj_log_level(context.get(), PJ_LOG_NONE);
  return context;
}

// Which transforms as PROJ does by default: the most exact way at each place.
// `ballpark`: also where it knows no way but to take one datum for the other.
inline ProjObject transformation(const ProjContext& context, const PJ* source, const PJ* target,
                                 bool ballpark) {
  const char* const options[] = {ballpark ? "ALLOW_BALLPARK=YES" : "ALLOW_BALLPARK=NO", nullptr};
  const ProjObject plain(
      proj_create_crs_to_crs_from_pj(context.get(), source, target, nullptr, options));
  if (!plain) return nullptr;
  // Longitude before latitude, easting before northing, whatever the system's own order.
  return ProjObject(proj_normalize_for_visualization(context.get(), plain.get()));
}

}  // namespace milepost
