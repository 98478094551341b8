#include "mapper/cli/build_output.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "mapper/acceptance/check_point_survey.h"
#include "mapper/cli/finding_output.h"
#include "schema/base/digits.h"

namespace milepost {
namespace {

using Json = nlohmann::ordered_json;

// The share of tracklets that two drives or more saw; nothing in a map of single drives.
std::string repeated_of(const MapReport& map) {
  if (map.repeated == 0) return "";
  const double share = static_cast<double>(map.repeated) / static_cast<double>(map.tracklets);
  return ", " + fixed(100 * share, 0) + " % seen by two drives or more";
}

// How well the map's positions are known in the world.
std::string position_of(const MapReport& map) {
  const double sigma_m = std::sqrt(map.position_square_m3 / map.length_m);
  const double assumed = map.assumed_m / map.length_m;
  std::string text = ", positions to " + fixed(sigma_m, 3) + " m";
  if (assumed >= 0.995) return text + " (assumed)";
  if (assumed > 0) text += " (assumed on " + fixed(100 * assumed, 0) + " % of the road)";
  return text;
}

// Where a vehicle will hardly be localized.
std::string sparse_of(const MapReport& map) {
  if (map.sparse_m == 0) return "";
  return ", few landmarks on " + fixed(map.sparse_m, 0) + " m";
}

// How well the images fit the poses, over all drives.
std::string fit_of(const BuildReport& report) {
  ImageWitness all;
  for (const DriveReport& drive : report.drives) all += drive.witness;
  if (all.tracks == 0) return "";
  return ", " + fixed(100 * all.fitting_share(), 0) +
         " % of the features that were followed fit to " + fixed(all.reprojection_rms_px(), 2) +
         " px";
}

std::string summary_line(const MapReport& map, const BuildReport& report) {
  const std::string segments =
      std::to_string(map.segments) + (map.segments == 1 ? " segment of " : " segments of ");
  const double tracklets_a_metre = static_cast<double>(map.tracklets) / map.length_m;
  const double kb_a_metre = static_cast<double>(map.tracklet_bytes) / 1000 / map.length_m;
  return map.file.string() + ": build " + map.build + ", " + segments + fixed(map.length_m, 1) +
         " m, " + std::to_string(report.frames) + " frames, " + std::to_string(map.tracklets) +
         " tracklets (" + fixed(tracklets_a_metre, 1) + " per metre) in " +
         std::to_string(map.tiles) + " tiles, " + fixed(kb_a_metre, 2) + " kB/m" +
         repeated_of(map) + position_of(map) + fit_of(report) + sparse_of(map);
}

std::string check_line(const std::vector<CheckPointResidual>& residuals) {
  const CheckPointSummary summary = summary_of(residuals);
  std::string line = "check points: " + std::to_string(summary.placed) + " of " +
                     std::to_string(summary.marks) + " placed";
  if (summary.placed == 0) return line;
  return line + ", off by " + fixed(summary.plan_rms_m, 3) + " m in plan and " +
         fixed(summary.up_rms_m, 3) + " m upwards (root mean squares), at most " +
         fixed(summary.worst_plan_m, 3) + " m in plan: " + summary.worst;
}

// What the images of each drive say of its poses.
Json json_of(const std::vector<DriveReport>& drives) {
  Json all = Json::array();
  for (const DriveReport& drive : drives) {
    const ImageWitness& witness = drive.witness;
    all.push_back({{"folder", drive.folder},
                   {"frames", drive.frames},
                   {"plan_rms_m", witness.plan_rms_m()},
                   {"up_rms_m", witness.up_rms_m()},
                   {"heading_rms_deg", witness.heading_rms_deg()},
                   {"reprojection_px", witness.reprojection_rms_px()},
                   {"fitting_share", witness.fitting_share()}});
  }
  return all;
}

Json json_of(const std::vector<MapReport>& maps) {
  Json all = Json::array();
  for (const MapReport& map : maps) {
    all.push_back({{"file", map.file.string()},
                   {"build", map.build},
                   {"segments", map.segments},
                   {"length_m", map.length_m},
                   {"tracklets", map.tracklets},
                   {"tiles", map.tiles},
                   {"few_landmarks_m", map.sparse_m}});
  }
  return all;
}

Json json_of(const std::vector<CheckPointResidual>& residuals) {
  Json all = Json::array();
  for (const CheckPointResidual& residual : residuals) {
    all.push_back(
        {{"mark", residual.mark}, {"drive", residual.drive}, {"sights", residual.sights}});
    if (!residual.is_placed) continue;
    all.back()["east_m"] = residual.east_m;
    all.back()["north_m"] = residual.north_m;
    all.back()["up_m"] = residual.up_m;
    all.back()["reprojection_px"] = residual.reprojection_px;
  }
  return all;
}

}  // namespace

std::string text_of(const BuildReport& report) {
  std::string text;
  for (const MapReport& map : report.maps) text += summary_line(map, report) + "\n";
  if (!report.check_points.empty()) text += check_line(report.check_points) + "\n";
  return text;
}

Json json_of(const BuildReport& report) {
  return {{"findings", json_of(report.findings)},
          {"drives", json_of(report.drives)},
          {"check_points", json_of(report.check_points)},
          {"maps", json_of(report.maps)}};
}

}  // namespace milepost
