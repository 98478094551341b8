// What the plan of a map can be coloured by, and the classes of each.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapper/report/segment_stretches.h"

namespace milepost {

struct ViewClass {
  std::string words;   // of the legend
  const char* colour;  // of the style sheet
};

struct StretchView {
  const char* name;                // of the switch
  const char* column;              // of the page's data, with the class of each stretch
  std::vector<ViewClass> classes;  // from the best to the worst
  const char* without;             // what a stretch without a value lacks
  const char* caption;
};

// In the order of the switch; the first is the one shown at first.
const std::vector<StretchView>& stretch_views();

// What the views show of a stretch.
struct StretchValues {
  std::optional<double> sigma_world_m;
  std::optional<double> sigma_map_m;
  std::optional<double> landmarks_per_m;
  std::optional<double> passes;
  std::optional<double> fit_percent;  // of the followed features of all drives
};

StretchValues values_of(const MapStretch& stretch, std::size_t passes);

// The class of a stretch in each view, by the order of stretch_views(); none without a value.
std::vector<std::optional<int>> classes_of(const StretchValues& values);

}  // namespace milepost
