// The routes, one function each. All are pure; errors become problem responses by their code.
#pragma once

#include "server/message/response.h"
#include "server/routes/call.h"

namespace milepost::server {

Result<Response> answer_health(const Call& call);         // /healthz
Result<Response> answer_ready(const Call& call);          // /readyz
Result<Response> answer_metrics(const Call& call);        // /metrics
Result<Response> answer_openapi(const Call& call);        // /openapi.yaml
Result<Response> answer_page(const Call& call);           // /
Result<Response> answer_viewer_file(const Call& call);    // /viewer/{release}/{file}
Result<Response> answer_maps(const Call& call);           // /v1/maps
Result<Response> answer_map(const Call& call);            // /v1/maps/{map}
Result<Response> answer_changes(const Call& call);        // /v1/maps/{map}/changes?from=B
Result<Response> answer_segments_near(const Call& call);  // /v1/segments?near=LAT,LON&radius_m=R
Result<Response> answer_manifest(const Call& call);       // .../manifest
Result<Response> answer_signature(const Call& call);      // .../manifest.sig
Result<Response> answer_summary(const Call& call);        // .../map
Result<Response> answer_mapping(const Call& call);        // .../mapping
Result<Response> answer_segment(const Call& call);        // .../segments/{segment}
Result<Response> answer_tile_range(const Call& call);     // .../tiles?layer=L&from_m=A&to_m=B
Result<Response> answer_tile(const Call& call);           // .../tiles/{layer}/{index}
Result<Response> answer_areas(const Call& call);          // .../areas
Result<Response> answer_cell_range(const Call& call);     // .../areas/{layer}?bbox=W,S,E,N
Result<Response> answer_cell(const Call& call);           // .../areas/{layer}/{cell}

// Under /viewer/maps/{map}/builds/{build}:
Result<Response> answer_viewer_landmarks(
    const Call& call);                                   // /segments/{segment}/landmarks/{index}
Result<Response> answer_viewer_walls(const Call& call);  // /walls/{cell}

}  // namespace milepost::server
