// The stretches of a map's segments as columns, and the parts that draw them.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "mapper/report/map_report_parts.h"
#include "mapper/report/stretch_views.h"
#include "schema/page/report_layers.h"
#include "schema/page/report_numbers.h"
#include "schema/page/report_plan.h"

namespace milepost {
namespace {

constexpr double kPlanStepM = 2.5;  // between points of a stretch on the plan

Json value_or_null(const std::optional<double>& value, int decimals) {
  return value ? rounded(*value, decimals) : Json(nullptr);
}

// The drive whose images fit worst on a stretch.
const StretchFit* worst_fit(const MapStretch& stretch) {
  const auto share = [](const StretchFit& each) {
    return static_cast<double>(each.fit.fitting) / static_cast<double>(each.fit.followed);
  };
  const StretchFit* worst = nullptr;
  for (const StretchFit& each : stretch.fits) {
    if (each.fit.followed == 0) continue;
    if (worst == nullptr || share(each) < share(*worst)) worst = &each;
  }
  return worst;
}

std::optional<double> fit_percent(const StretchFit* fit) {
  if (fit == nullptr) return std::nullopt;
  return 100 * static_cast<double>(fit->fit.fitting) / static_cast<double>(fit->fit.followed);
}

// The columns of all stretches, a value a stretch.
class Columns {
 public:
  Columns(Json& page, const MapReportData& data) : columns_(page["columns"]), frame_(data.centre) {
    for (std::size_t i = 0; i < data.drives.size(); ++i) drive_index_[data.drives[i].name] = i;
  }

  void add(std::size_t segment, const SegmentReport& report, const MapStretch& stretch) {
    const std::size_t passes = report.inspected.stored.passes.size();
    const StretchValues values = values_of(stretch, passes);
    push("segment", segment);
    push("from_m", rounded(stretch.along.from_m, 1));
    push("to_m", rounded(stretch.along.to_m, 1));
    push("along_m", rounded(stretch.along.middle_m(), 2));
    push("landmarks", stretch.landmarks);
    push("landmarks_per_m", value_or_null(values.landmarks_per_m, 1));
    push("in_sight", stretch.in_sight);
    push("repeated_percent", stretch.in_sight == 0
                                 ? Json(nullptr)
                                 : rounded(100.0 * stretch.repeated / stretch.in_sight, 0));
    push("passes", passes);
    push("gap", stretch.has_gap ? 1 : 0);
    push("sigma_m", value_or_null(values.sigma_world_m, 3));
    push("sigma_map_m", value_or_null(values.sigma_map_m, 3));
    push("fit_percent", value_or_null(values.fit_percent, 1));
    const StretchFit* worst = worst_fit(stretch);
    push("worst_fit_percent", value_or_null(fit_percent(worst), 1));
    push("worst_fit_drive", worst == nullptr ? Json(nullptr) : drive_of(worst->drive));
    const std::vector<std::optional<int>> classes = classes_of(values);
    for (std::size_t view = 0; view < classes.size(); ++view)
      push(stretch_views()[view].column, classes[view] ? Json(*classes[view]) : Json(nullptr));
    const PlanPoint middle = on_plan(frame_, report.line.point_at(stretch.along.middle_m()));
    push("east_m", rounded(middle.x, 1));
    push("north_m", rounded(middle.y, 1));
    add_way(report.line, stretch.along);
  }

 private:
  void push(const char* column, Json value) { columns_[column].push_back(std::move(value)); }

  Json drive_of(const std::string& name) const {
    const auto found = drive_index_.find(name);
    return found == drive_index_.end() ? Json(nullptr) : Json(found->second);
  }

  // The stretch's line on the plan: its points are those from its `way_first` on, `way_points`.
  void add_way(const RouteLine& line, const AlongRange& along) {
    const auto steps =
        std::max(1L, static_cast<long>(std::ceil((along.to_m - along.from_m) / kPlanStepM - 1e-9)));
    push("way_first", way_points_);
    push("way_points", steps + 1);
    for (long k = 0; k <= steps; ++k) {
      const double along_m = along.from_m + (along.to_m - along.from_m) * static_cast<double>(k) /
                                                static_cast<double>(steps);
      const PlanPoint at = on_plan(frame_, line.point_at(along_m));
      push("way_east_m", rounded(at.x, 1));
      push("way_north_m", rounded(at.y, 1));
      ++way_points_;
    }
  }

  Json& columns_;
  LocalFrame frame_;
  std::map<std::string, std::size_t> drive_index_;
  std::size_t way_points_ = 0;
};

Json readout_row(const char* name, const char* column, int decimals, const char* unit) {
  return {{"name", name},
          {"values", Json::array({{{"label", ""},
                                   {"column", column},
                                   {"decimals", decimals},
                                   {"signed", false},
                                   {"unit", unit}}})}};
}

Json words_row(const char* name, const char* column, const Json& words) {
  Json row = readout_row(name, column, 0, "");
  row["values"][0]["words"] = words;
  return row;
}

bool has_fit(const MapReportData& data) {
  return std::ranges::any_of(data.segments, [](const SegmentReport& segment) {
    return std::ranges::any_of(segment.stretches,
                               [](const MapStretch& each) { return !each.fits.empty(); });
  });
}

Json readout_rows(const MapReportData& data) {
  Json drives = Json::array();
  for (const MappedDrive& drive : data.drives) drives.push_back(drive.name);
  Json rows =
      Json::array({readout_row("\u03C3 of a fix in the world", "sigma_m", 3, "m"),
                   readout_row("\u03C3 against the map", "sigma_map_m", 3, "m"),
                   readout_row("landmarks that begin here", "landmarks", 0, ""),
                   readout_row("landmarks a metre", "landmarks_per_m", 1, ""),
                   readout_row("landmarks in sight, at least", "in_sight", 0, ""),
                   readout_row("... seen by two drives or more", "repeated_percent", 0, "%"),
                   readout_row("passes", "passes", 0, "")});
  if (!has_fit(data)) return rows;
  rows.push_back(readout_row("fit of the images", "fit_percent", 1, "%"));
  rows.push_back(readout_row("fit of the worst drive", "worst_fit_percent", 1, "%"));
  rows.push_back(words_row("the worst drive", "worst_fit_drive", drives));
  return rows;
}

Json json_of(const StretchView& view) {
  Json classes = Json::array();
  for (const ViewClass& each : view.classes)
    classes.push_back({{"name", each.words}, {"colour", each.colour}});
  return {{"name", view.name},
          {"column", view.column},
          {"classes", classes},
          {"without", view.without},
          {"caption", view.caption}};
}

std::string passes_text(const StoredSegment& segment) {
  std::map<std::string, std::size_t> times;
  for (const StoredPass& pass : segment.passes) ++times[pass.drive];
  std::vector<std::string> words;
  words.reserve(times.size());
  for (const auto& [drive, count] : times)
    words.push_back(count == 1 ? drive : drive + " (" + std::to_string(count) + " times)");
  if (words.empty()) return "no pass is recorded";
  const std::size_t passes = segment.passes.size();
  return std::to_string(passes) + (passes == 1 ? " pass: " : " passes: ") + listed(words);
}

// A segment for the reader's choice.
Json json_of(const SegmentReport& report, std::size_t first) {
  const StoredSegment& stored = report.inspected.stored;
  const PositionError& error = stored.position_error;
  std::vector<std::string> goes_to;
  for (const Successor& each : stored.successors)
    goes_to.push_back(each.map.empty() ? each.segment : each.map + "/" + each.segment);
  Json gaps = Json::array();
  for (const AlongRange& gap : report.inspected.gaps)
    gaps.push_back({rounded(gap.from_m, 1), rounded(gap.to_m, 1)});
  return {{"name", stored.id},
          {"first", first},
          {"end", first + report.stretches.size()},
          {"length_m", rounded(stored.length_m, 1)},
          {"gaps", gaps},
          {"facts",
           {{"Length", number(stored.length_m, 1) + "\u00A0m"},
            {"Passes", passes_text(stored)},
            {"Landmarks", std::to_string(report.inspected.landmarks)},
            {"Map positions known to",
             error.sigma_m ? metres(*error.sigma_m) + (error.is_assumed ? ", assumed" : "")
                           : std::string("not known")},
            {"Goes on to", goes_to.empty() ? "no other segment" : listed(goes_to)}}}};
}

PlanArea area_of(const MapReportData& data) {
  constexpr double kLeastWidthM = 60;
  constexpr double kLeastHeightShare = 0.3;
  constexpr double kMostHeightShare = 0.75;
  constexpr double kMargin = 1.12;
  const LocalFrame frame(data.centre);
  PlanArea area;
  for (const SegmentReport& segment : data.segments) {
    for (const GeoPoint& vertex : segment.line.vertices()) area.include({on_plan(frame, vertex)});
  }
  const double margin_m = (kMargin - 1) * std::max(area.east.length(), area.north.length());
  area.east.widen_to(std::max(kLeastWidthM, area.east.length() + margin_m));
  area.north.widen_to(
      std::max(kLeastHeightShare * area.east.length(), area.north.length() + margin_m));
  area.east.widen_to(std::max(area.east.length(), area.north.length() / kMostHeightShare));
  return area;
}

// Thin enough that roads beside one another can be told apart.
double line_width_px(double area_width_m) {
  return area_width_m > 3000 ? 3 : area_width_m > 800 ? 4 : 5.5;
}

// A mark that several drives saw is drawn once.
void add_check_points(Json& layers, const MapReportData& data) {
  const LocalFrame frame(data.centre);
  std::map<std::string, PlanPoint> marks;
  for (const CheckPointResidual& each : data.check_points)
    marks[each.mark] = on_plan(frame, {each.latitude_deg, each.longitude_deg, each.altitude_m});
  if (marks.empty()) return;
  Json names = Json::array();
  std::vector<PlanPoint> points;
  for (const auto& [name, at] : marks) {
    names.push_back(name);
    points.push_back(at);
  }
  layers.push_back(
      circles_layer("surveyed mark", "ink", "page", 4.5, 2, easts(points), norths(points)));
  layers.push_back(texts_layer(names, {"left", 8, 4}, easts(points), norths(points)));
}

// What needs a look first: the longest gaps, then the largest sigma against the map.
std::vector<std::size_t> by_need(const MapReportData& data) {
  struct Need {
    double gaps_m = 0;
    double sigma_m = 0;
  };
  std::vector<Need> needs;
  for (const SegmentReport& segment : data.segments) {
    Need need;
    for (const AlongRange& gap : segment.inspected.gaps) need.gaps_m += gap.to_m - gap.from_m;
    for (const MapStretch& stretch : segment.stretches) {
      if (stretch.sigma_map) need.sigma_m = std::max(need.sigma_m, stretch.sigma_map->worse_m());
    }
    needs.push_back(need);
  }
  std::vector<std::size_t> order(needs.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return std::tie(needs[b].gaps_m, needs[b].sigma_m) <
           std::tie(needs[a].gaps_m, needs[a].sigma_m);
  });
  return order;
}

// A plot along the chosen segment; the page fills in its range and gaps.
Json along_plot(const char* description, int height_px, const Json& y, Json layers) {
  return {{"description", description},
          {"height_px", height_px},
          {"y", y},
          {"layers", std::move(layers)}};
}

Json steps(const char* name, const char* colour, double width_px, const char* column) {
  Json layer = line_layer(name, colour, width_px, "from_m", column);
  layer["steps"] = true;
  return layer;
}

// The page sets the upper end to the chosen segment's values, but not below `least`.
Json axis_up_to(double least, const std::string& label, int decimals) {
  Json y = axis(label, 0, least, decimals);
  y["grows"] = true;
  return y;
}

Json sigma_axis() {
  Json y = axis_up_to(0.2, "\u03C3 of a fix (m)", 3);
  y["log"] = true;
  y["min"] = 0.01;
  return y;
}

}  // namespace

void add_stretches(Json& page, const MapReportData& data) {
  Columns columns(page, data);
  Json segments = Json::array();
  std::size_t first = 0;
  for (std::size_t i = 0; i < data.segments.size(); ++i) {
    const SegmentReport& report = data.segments[i];
    segments.push_back(json_of(report, first));
    for (const MapStretch& stretch : report.stretches) columns.add(i, report, stretch);
    first += report.stretches.size();
  }
  Json views = Json::array();
  for (const StretchView& view : stretch_views()) views.push_back(json_of(view));
  page["frames"] = {
      {"x", "along_m"},   {"from", "from_m"},          {"to", "to_m"},  {"names", "segment"},
      {"east", "east_m"}, {"north", "north_m"},        {"decimals", 0}, {"unit", "m"},
      {"label", ""},      {"rows", readout_rows(data)}};
  page["segments"] = segments;
  page["views"] = views;
}

Json plan_part(const MapReportData& data) {
  const PlanArea area = area_of(data);
  const double width_px = line_width_px(area.east.length());
  Json plot = plan_plot(area, "The segments of the map in plan view, coloured by the choice above");
  plot["stretches"] = true;
  plot["layers"].push_back({{"kind", "chosen"}, {"colour", "ink"}, {"width_px", 2 * width_px}});
  plot["layers"].push_back({{"kind", "stretches"}, {"colour", "road"}, {"width_px", width_px}});
  plot["layers"].push_back({{"kind", "gaps"},
                            {"name", "too few landmarks for a fix"},
                            {"colour", "ink"},
                            {"width_px", 2},
                            {"dash", {3, 4}}});
  add_check_points(plot["layers"], data);
  return {{"part", "plan"},
          {"heading", "The road network"},
          {"plot", plot},
          {"caption",
           "Metres east and north of the map's centre, to scale. Where lines lie on one another "
           "the worse is on top. A click on a stretch shows its segment below. Too few landmarks "
           "are fewer than 20 in sight on ten metres or more."}};
}

Json strips_part(const MapReportData& data) {
  return {{"part", "strips"},
          {"heading", "Each segment, ten metres a cell"},
          {"order", by_need(data)},
          {"caption",
           "In the colours of the plan. A segment of more than 500 m goes on in the next line. "
           "First those with the longest stretches of too few landmarks, which have a bar beneath, "
           "then those with the largest \u03C3 against the map."}};
}

Json segment_part(const MapReportData& data) {
  Json plots = Json::array(
      {along_plot("\u03C3 of a fix along the segment", 150, sigma_axis(),
                  Json::array({steps("in the world", "m0", 1.8, "sigma_m"),
                               steps("against the map", "m1", 1.8, "sigma_map_m")})),
       along_plot("Landmarks a metre along the segment", 110, axis_up_to(4, "landmarks a metre", 1),
                  Json::array({steps("landmarks a metre", "m2", 1.8, "landmarks_per_m")})),
       along_plot(
           "Landmarks in sight seen by two drives or more, along the segment", 90,
           axis("seen by two drives or more (%)", 0, 100, 0),
           Json::array({steps("seen by two drives or more", "m3", 1.8, "repeated_percent")}))});
  if (has_fit(data)) {
    plots.push_back(along_plot(
        "Fit of the images along the segment", 90, axis("features that fit (%)", 0, 100, 0),
        Json::array({steps("of all drives", "m4", 1.8, "fit_percent"),
                     steps("of the worst drive", "m8", 1.2, "worst_fit_percent")})));
  }
  return {{"part", "segment"},
          {"heading", "Along one segment"},
          {"label", "along the segment (m)"},
          {"plots", plots},
          {"caption",
           std::string("Ten metres a step. The bars under the axes mark stretches with too few "
                       "landmarks for a fix.") +
               (has_fit(data) ? "" : " The fit of the images is not recorded in this map.")}};
}

}  // namespace milepost
