// All that the localizer needs of the segment it is on.
#pragma once

#include <memory>
#include <string>

#include "client/fetch/map_source.h"
#include "client/localize/tracklet_window.h"
#include "schema/feature/types.h"
#include "schema/geo/route_line.h"

namespace milepost {

struct SegmentSession {
  MapVersion version;
  std::string segment;
  RouteLine line;
  FeatureParameters feature;  // that the map's descriptors were made with
  double map_focal_px = 0;    // geometric mean of the map camera's focal lengths
  TrackletWindow window;
};

// Errors: those of the source; invalid_input if the map has no layer `layer`; corrupt.
Result<SegmentSession> open_session(const std::shared_ptr<MapSource>& source,
                                    const MapVersion& version, const std::string& segment,
                                    const std::string& layer, const WindowSettings& settings);

}  // namespace milepost
