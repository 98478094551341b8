// Layers of plots with their style and data. A layer without a name is not in the legend; x and y
// are arrays, or names of the page's columns. More properties can be set on the result.
#pragma once

#include <string>

#include "schema/page/report_json.h"

namespace milepost {

Json line_layer(const std::string& name, const std::string& colour, double width_px, Json x = {},
                Json y = {});
Json dots_layer(const std::string& name, const std::string& colour, double radius_px, Json x = {},
                Json y = {});
// Circles with an edge.
Json circles_layer(const std::string& name, const std::string& edge, const std::string& fill,
                   double radius_px, double edge_px, Json x = {}, Json y = {});
// The area below a line, or between it and its mirror image at zero (kind band).
Json area_layer(const std::string& name, const std::string& colour, Json x, Json y);

struct Words {
  const char* align = "left";  // horizontal, relative to the point: left, center, right
  int right_px = 0;
  int down_px = 0;
};

// A text next to each point.
Json texts_layer(const Json& text, const Words& words, Json x, Json y);

// A legend entry for the mark of a status.
Json status_key(const std::string& status);

}  // namespace milepost
