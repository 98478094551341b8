// The JSON that a report's page is made from (page/ shows it, and tests/lab makes it, too).
//
// {kind, title, lead, facts: [[name, value], ...], columns: {name: [one value a frame]}, parts:
// [...],
//  frames: {x, names, east, north, label, unit, decimals, rows}, ground: {picture}}
//
// A part is a table, a figure of plots, or a group of parts. A plot has two axes and layers, from
// back to front, of the kinds line, dots, band, area and texts; their x and y are arrays or names
// of columns. Plots of frames share one cursor and one zoom. null stands for a number that is not
// known. Colours are names of the style sheet's variables.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "schema/drive/drive.h"

namespace milepost {

using Json = nlohmann::ordered_json;

// To so many decimals; null where not finite.
Json rounded(double value, int decimals);
Json rounded(const std::vector<double>& values, int decimals);

struct Figure {
  std::string heading;
  std::string caption;         // how to read it, and the numbers behind
  Json plots = Json::array();  // none: there is nothing to draw
  Json keys = Json::array();   // of the legend, beside those of the layers
};

Json json_of(const Figure& figure);

Json axis(const std::string& label, double min, double max, int decimals = 2);
Json table_column(const std::string& heading, const std::string& unit, int decimals);
Json words_column(const std::string& heading);  // of the names of rows

// Names and values.
using Facts = std::vector<std::pair<std::string, std::string>>;

// When the drive was captured, its frames, where it comes from and its licence.
Facts facts_of(const Drive& drive);
std::string title_of(const Drive& drive);  // or what stands for one that has none

struct PageHead {
  std::string kind;   // "evaluation"
  std::string title;  // of this page among its kind
  std::string lead;   // the result in a sentence or two
  Facts facts;
};

// Of a page without columns and parts.
Json json_of(const PageHead& head);

}  // namespace milepost
