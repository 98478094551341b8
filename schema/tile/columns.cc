#include "schema/tile/columns.h"

#include <algorithm>
#include <cmath>

#include "schema/base/ids.h"

namespace milepost {

std::uint16_t whole_pixel(float px) {
  return static_cast<std::uint16_t>(std::clamp(px, 0.0F, 65535.0F));
}

Error broken_tile(const std::string& where, const std::string& what, const std::string& paragraph) {
  return {ErrorCode::corrupt, where, what + " (FORMAT.md " + paragraph + ")",
          "fetch the tile again or replace the map with a good copy"};
}

Status check_head(std::string_view segment, double origin_m) {
  if (!is_segment_id(segment)) return broken_tile("tile", "the segment id is invalid", "3.4");
  if (!(std::abs(origin_m) <= kMaxAlongM)) {
    return broken_tile("tile", "origin_m is out of range", "3.4");
  }
  return ok_status();
}

Status check_model(std::uint8_t model) {
  if (model <= static_cast<std::uint8_t>(ScaleModel::inverse_scale)) return ok_status();
  return broken_tile("tile", "the scale model is unknown", "3.4");
}

Status check_lengths(const std::string& where, const NamedLength& reference,
                     std::initializer_list<NamedLength> arrays, const std::string& paragraph) {
  for (const NamedLength& array : arrays) {
    if (array.length == reference.length) continue;
    return broken_tile(
        where, std::string("the length of ") + array.name + " is not that of " + reference.name,
        paragraph);
  }
  return ok_status();
}

// Each comparison is written so that NaN fails it.
Status check_tracklet(const Tracklet& t, const std::string& where) {
  const struct {
    bool holds;
    const char* what;
    const char* paragraph;
  } rules[] = {
      {std::isfinite(t.offset_m), "the offset is not finite", "3.6"},
      {t.slope > 0 && std::isfinite(t.slope), "the slope is not finite and above 0", "3.6"},
      {t.scale_min_px > 0, "the smallest scale is not above 0", "3.7"},
      {t.scale_min_px <= t.scale_max_px && std::isfinite(t.scale_max_px),
       "the largest scale is not finite and at least the smallest", "3.7"},
      {std::abs(t.along.from_m) <= kMaxAlongM && std::abs(t.along.to_m) <= kMaxAlongM,
       "the along range is out of range", "3.8"},
      {t.along.from_m <= t.along.to_m, "the along range ends before it begins", "3.8"},
      {t.pixels.x_min_px <= t.pixels.x_max_px && t.pixels.y_min_px <= t.pixels.y_max_px,
       "the pixel range ends before it begins", "3.9"},
      {t.r_squared >= 0 && t.r_squared <= 1, "R squared is not in [0, 1]", "3.10"},
      {t.residual_sigma_m >= 0 && std::isfinite(t.residual_sigma_m),
       "the residual sigma is not finite and at least 0", "3.10"},
      {t.observations >= 3, "fewer than 3 observations", "3.10"},
  };
  for (const auto& rule : rules) {
    if (!rule.holds) return broken_tile(where, rule.what, rule.paragraph);
  }
  return ok_status();
}

}  // namespace milepost
