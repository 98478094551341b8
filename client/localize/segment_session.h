// What the localizer knows of the segment it is on, whatever the method.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "client/localize/tile_window.h"
#include "client/localize/tracked_position.h"
#include "schema/feature/codebook.h"
#include "schema/feature/types.h"
#include "schema/geo/route_line.h"
#include "schema/tile/layer_items.h"

namespace milepost {

struct SegmentSession {
  LayerSource layer;  // that the method needs
  LayerItems items = LayerItems::tracklets;
  RouteLine line;
  FeatureParameters feature;         // that the map's descriptors were made with
  double map_focal_px = 0;           // geometric mean of the map camera's focal lengths
  std::optional<Codebook> codebook;  // of a layer of landmarks

  // In the world: beside the line, where the method knows how far.
  GeoPoint position_of(const TrackedPosition& at) const {
    return at.across ? at.across->position : line.point_at(at.along_m);
  }
};

// Errors: those of the source; invalid_input if the map has no layer of that name; corrupt.
Result<SegmentSession> open_session(const LayerSource& layer);

}  // namespace milepost
