// Histograms of the report of a map.
#pragma once

#include <string>
#include <vector>

#include "schema/page/report_json.h"

namespace milepost {

struct HistogramValues {
  std::string name;  // of the legend; may be empty
  const char* colour;
  std::vector<double> values;  // not negative
};

struct HistogramAxis {
  std::string label;      // with the unit
  std::string of;         // what is counted: "stretches"
  bool is_whole = false;  // of whole numbers, with a bin each
};

// From zero up, in percent of each set's values. The last bin holds all that is beyond it. Empty
// figure without values.
Figure histogram_figure(const std::string& heading, const std::string& caption,
                        const HistogramAxis& of, const std::vector<HistogramValues>& sets);

}  // namespace milepost
