// The head of the report of a map.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "mapper/report/map_report_parts.h"
#include "schema/page/report_numbers.h"

namespace milepost {
namespace {

std::string length_text(double length_m) {
  return length_m < 1000 ? number(length_m, 0) + "\u00A0m"
                         : number(length_m / 1000, length_m < 10'000 ? 2 : 1) + "\u00A0km";
}

std::string per_metre_text(double value, double length_m, int decimals) {
  return length_m > 0 ? number(value / length_m, decimals) : "\u2013";
}

double percent_of(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

const LayerInspection* default_layer(const MapInspection& map) {
  const auto found = std::ranges::find_if(
      map.layers, [](const LayerInspection& layer) { return layer.items == "landmarks"; });
  return found == map.layers.end() ? nullptr : &*found;
}

// "0.08 to 0.18 m", with how much of the road has an assumed one.
std::string positions_text(const MapReportData& data) {
  double least_m = kNaN;
  double most_m = kNaN;
  double known_m = 0;
  double assumed_m = 0;
  for (const SegmentReport& segment : data.segments) {
    const StoredSegment& stored = segment.inspected.stored;
    const PositionError& error = stored.position_error;
    if (!error.sigma_m) continue;
    least_m = std::fmin(least_m, *error.sigma_m);
    most_m = std::fmax(most_m, *error.sigma_m);
    known_m += stored.length_m;
    if (error.is_assumed) assumed_m += stored.length_m;
  }
  if (known_m <= 0) return "not known";
  const std::string range = metres(least_m) == metres(most_m)
                                ? metres(most_m)
                                : number(least_m, 3) + " to " + number(most_m, 3) + "\u00A0m";
  if (assumed_m <= 0) return range + ", from the drives";
  if (assumed_m >= data.length_m()) return range + ", assumed";
  return range + ", assumed on " + number(percent_of(assumed_m, data.length_m()), 0) +
         "\u00A0% of the road";
}

std::string repeated_text(const MapReportData& data) {
  std::uint64_t repeated = 0;
  for (const SegmentReport& segment : data.segments) repeated += segment.inspected.repeated;
  return number(
             percent_of(static_cast<double>(repeated), static_cast<double>(data.landmark_count())),
             0) +
         "\u00A0% of the landmarks";
}

struct Gaps {
  std::size_t count = 0;
  double length_m = 0;
};

Gaps gaps_of(const MapReportData& data) {
  Gaps gaps;
  for (const SegmentReport& segment : data.segments) {
    for (const AlongRange& gap : segment.inspected.gaps) {
      ++gaps.count;
      gaps.length_m += gap.to_m - gap.from_m;
    }
  }
  return gaps;
}

std::string gaps_text(const Gaps& gaps) {
  if (gaps.count == 0) return "none";
  return length_text(gaps.length_m) + " in " + counted(gaps.count, "place");
}

// Of the road's length, where a fix is known to be at most this far off.
double share_within_percent(const MapReportData& data, double limit_m) {
  double within_m = 0;
  for (const SegmentReport& segment : data.segments) {
    for (const MapStretch& stretch : segment.stretches) {
      if (stretch.sigma_world_m && *stretch.sigma_world_m <= limit_m)
        within_m += stretch.length_m();
    }
  }
  return percent_of(within_m, data.length_m());
}

std::string findings_clause(const MapReportData& data) {
  if (!data.findings) return " What the build found is not recorded in it.";
  if (data.findings->empty()) return " The build had no findings.";
  return " The build had " + counted(data.findings->size(), "finding") + ".";
}

std::string lead_of(const MapReportData& data) {
  constexpr double kDecimetreM = 0.1;
  constexpr double kAssumedM = 0.2;
  if (data.segments.empty()) return "The map has no segments.";
  const Gaps gaps = gaps_of(data);
  return "On " + number(share_within_percent(data, kDecimetreM), 0) + "\u00A0% of the road a fix " +
         "would have a \u03C3 in the world of 0.1\u00A0m or less, on " +
         number(share_within_percent(data, kAssumedM), 0) + "\u00A0% of 0.2\u00A0m or less. " +
         (gaps.count == 0 ? "Nowhere are fewer than 20 landmarks in sight on ten metres."
                          : "On " + gaps_text(gaps) + " there are too few landmarks for one.") +
         findings_clause(data);
}

}  // namespace

PageHead map_head(const MapReportData& data) {
  const MapInspection& map = data.map;
  const double length_m = data.length_m();
  const LayerInspection* layer = default_layer(map);
  const std::filesystem::path file(map.file);
  return {"map",
          file.stem().string(),
          lead_of(data),
          {{"File", file.filename().string() + ", " +
                        number(static_cast<double>(map.bytes) / 1e6, 2) + "\u00A0MB"},
           {"Build", map.build},
           {"Length", length_text(length_m)},
           {"Segments", std::to_string(data.segments.size())},
           {"Drives", std::to_string(data.drives.size())},
           {"Landmarks a metre",
            per_metre_text(static_cast<double>(data.landmark_count()), length_m, 1)},
           {"kB a metre",
            per_metre_text(layer == nullptr ? 0 : static_cast<double>(layer->bytes) / 1000,
                           length_m, 2)},
           {"Map positions known to", positions_text(data)},
           {"Seen by two drives or more", repeated_text(data)},
           {"Too few landmarks", gaps_text(gaps_of(data))}}};
}

}  // namespace milepost
