// The JSON data of a report page (shown by the scripts of this folder, also produced by tests/lab):
//
// {kind, title, lead, facts: [[name, value], ...], columns: {name: [one value per frame]},
//  parts: [...], frames: {x, names, east, north, label, unit, decimals, rows}, ground: {picture}}
//
// In the report of a map the frames are stretches of its segments, and there are, too,
// {segments: [{name, first, end, length_m, gaps, facts}, ...],
//  views: [{name, column, classes: [{name, colour}, ...], without, caption}, ...]}.
//
// A part is a table, a figure of plots, or a group of parts. A plot has two axes and layers, from
// back to front, of the kinds line, dots, band, area and texts; their x and y are arrays or names
// of columns. Plots over frames share one cursor and one zoom. null is an unknown number. Colours
// are names of variables in the style sheet.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace milepost {

using Json = nlohmann::ordered_json;

// Rounded to a number of decimals; null if not finite.
Json rounded(double value, int decimals);
Json rounded(const std::vector<double>& values, int decimals);

struct Figure {
  std::string heading;
  std::string caption;         // how to read it, and the underlying numbers
  Json plots = Json::array();  // empty: there is nothing to draw
  Json keys = Json::array();   // of the legend, in addition to those of the layers
};

Json json_of(const Figure& figure);

Json axis(const std::string& label, double min, double max, int decimals = 2);
Json table_column(const std::string& heading, const std::string& unit, int decimals);
Json words_column(const std::string& heading);  // of row names
Json text_column(const std::string& heading);   // of other texts

// Names and values.
using Facts = std::vector<std::pair<std::string, std::string>>;

struct PageHead {
  std::string kind;   // "evaluation"
  std::string title;  // of this page
  std::string lead;   // the result in one or two sentences
  Facts facts;
};

// The data of a page without columns and parts.
Json json_of(const PageHead& head);

}  // namespace milepost
