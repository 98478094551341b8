#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <set>
#include <thread>

#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>

#include "mapper/cli/build_output.h"
#include "mapper/cli/commands.h"
#include "mapper/cli/finding_output.h"
#include "mapper/codebook/codebook.h"
#include "mapper/findings/datum_findings.h"
#include "mapper/findings/drive_findings.h"
#include "mapper/pipeline/build_map.h"
#include "schema/base/digits.h"
#include "schema/base/output_file.h"
#include "schema/command/command.h"
#include "schema/store/map_output.h"

namespace milepost {
namespace {

constexpr const char* kBuildDescription =
    R"(Builds a map from recorded drives.

All drives make one road network: its segments end where drives part or join, and where several
drove, a segment takes one pass, or with --passes fuse all. --border divides the network into two
maps, and a vehicle passes from one to the other as at a junction. Segments hold tracklets: SIFT
features tracked over consecutive frames. For the default method each becomes a landmark, and the
most informative are kept; with --lab there is a layer for each method to compare with, too. A drive
in which nothing is found ends the build, and an old map stays.
Example: milepost-mapper build --drive drives/monday --map maps/town.map)";

constexpr const char* kBuildSettings = "Settings (each changes the map)";

struct BuildOptions {
  std::vector<std::string> drives;
  std::string map;
  std::string codebook;
  std::vector<double> border_deg;
  std::string beyond;
  std::string check_points;
  std::string check_crs;
  std::optional<double> max_check_m;
  bool dry_run = false;
  bool json = false;
  int jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  BuildSettings settings;
};

const std::map<std::string, PassPolicy> kPassPolicies = {{"fuse", PassPolicy::fuse},
                                                         {"keep-best", PassPolicy::keep_best},
                                                         {"replace", PassPolicy::replace}};

// What is wrong with a word; empty for a policy.
std::string wrong_pass_policy(const std::string& word) {
  return kPassPolicies.contains(word) ? ""
                                      : "'" + word + "' is none; choose fuse, keep-best or replace";
}

void add_check_point_options(CLI::App& app, BuildOptions& options) {
  CLI::Option* check_points =
      app.add_option(
             "--check-points", options.check_points,
             "Table of surveyed marks and where images show them: columns mark,\n"
             "latitude_deg, longitude_deg, altitude_m, filename, x_px, y_px and, with several\n"
             "drives, drive; tells how far off the map has them")
          ->option_text("FILE");
  app.add_option("--check-crs", options.check_crs,
                 "Reference system of the marks, whose columns are then x, y, z")
      ->needs(check_points)
      ->option_text("CRS");
  app.add_option("--max-check-m", options.max_check_m,
                 "The build fails if marks are farther off in plan (root mean square)")
      ->needs(check_points)
      ->check(CLI::Range(0.0, 1000.0))
      ->option_text("M");
}

void add_build_options(CLI::App& app, BuildOptions& options) {
  app.add_option("--drive", options.drives, "Folder of a recorded drive; may be repeated")
      ->required()
      ->option_text("DIR");
  app.add_option("--map", options.map,
                 "Map file to write; an existing map is replaced on success, any other file never")
      ->option_text("FILE");
  app.add_flag("--dry-run", options.dry_run,
               "Only tell what is wrong with the drives, within seconds, and write nothing");
  app.add_flag("--json", options.json, "Tell findings and maps on standard output as JSON");
  add_number(app, "--jobs", options.jobs, "N",
             "Threads that extract features; the map is the same for any number", 1, 256);
  app.add_option("--codebook", options.codebook,
                 "Codebook file instead of the one that ships with milepost")
      ->option_text("FILE");
  const auto set_passes = [&options](const std::string& word) {
    options.settings.passes = kPassPolicies.at(word);
  };
  app.add_option_function<std::string>(
         "--passes", set_passes,
         "Landmarks that a segment takes where several drove: those of all, fitted to\n"
         "each other (default), of the pass in which most is seen, or of the latest")
      ->check(wrong_pass_policy)
      ->option_text("fuse|keep-best|replace");
  CLI::Option* border =
      app.add_option("--border", options.border_deg,
                     "Line through two points, in WGS84 degrees, at which the network is divided:\n"
                     "what is left of it, from the first point to the second, goes to --map")
          ->expected(4)
          ->delimiter(',')
          ->option_text("LAT,LON,LAT,LON");
  CLI::Option* beyond = app.add_option("--beyond", options.beyond,
                                       "Map file to write with what is right of the border")
                            ->option_text("FILE");
  border->needs(beyond);
  beyond->needs(border);
  app.add_flag("--lab", options.settings.lab, "Add the layers of the methods for comparison");
  add_check_point_options(app, options);
  add_number(app, "--min-fitting-share", options.settings.min_fitting_share, "X",
             "The build fails if of a drive's followed features a smaller share fits its poses", 0,
             1);
  app.add_flag("--allow-empty", options.settings.allow_empty,
               "Write the map even if nothing was found for it");

  BuildSettings& settings = options.settings;
  const auto setting = [&app](const std::string& name, auto& value, const std::string& unit,
                              const std::string& text, auto low, auto high) {
    using Number = std::remove_reference_t<decltype(value)>;
    add_number(app, "--" + name, value, unit, text, static_cast<Number>(low),
               static_cast<Number>(high))
        ->group(kBuildSettings);
  };
  setting("max-features", settings.feature.max_features, "N",
          "Strongest features kept per frame; 0: all", 0, 1000000);
  setting("contrast-threshold", settings.feature.contrast_threshold, "X", "SIFT contrast threshold",
          0, 1);
  setting("min-r-squared", settings.min_r_squared, "X",
          "Minimum R^2 of a tracklet's regression (--lab)", 0, 1);
  setting("min-observations", settings.follow.min_observations, "N", "Minimum frames of a tracklet",
          3, 1000);
  setting("max-distance-ratio", settings.follow.max_distance_ratio, "X",
          "Ratio test of descriptor distances", 0.1, 1);
  setting("search-radius-px", settings.follow.search_radius_px, "PX",
          "Minimum radius of the search area of a tracked feature", 1, 500);
  setting("size-target-kb-per-m", settings.landmarks.size_target_kb_per_m, "KB",
          "Maximum size of the default method's layer; more landmarks are more accurate", 0.01,
          1000);
  setting("tile-length-m", settings.tile_length_m, "M", "Length of road per tile", 1, 100);
  setting("min-frame-spacing-m", settings.min_frame_spacing_m, "M",
          "Frames nearer to the last one used are skipped", 0.01, 100);
}

Status check_maps_are_free(const std::vector<Drive>& drives, const BuildOptions& options) {
  std::vector<std::filesystem::path> inputs;
  for (const Drive& drive : drives) {
    const std::vector<std::filesystem::path> files = files_of(drive);
    inputs.insert(inputs.end(), files.begin(), files.end());
  }
  std::vector<Output> outputs = {{"--map", options.map, &kMapOutput}};
  if (!options.beyond.empty()) outputs.push_back({"--beyond", options.beyond, &kMapOutput});
  return check_outputs(outputs, inputs);
}

// The division that the options ask for, if any.
Result<std::optional<Division>> division_of(const BuildOptions& options) {
  if (options.border_deg.empty()) return std::optional<Division>();
  const std::vector<double>& deg = options.border_deg;
  Result<Border> border = Border::through({deg[0], deg[1], 0}, {deg[2], deg[3], 0});
  if (!border) return border.error();
  return std::optional(Division{std::move(*border), options.beyond});
}

// An error is one line, which names what was found before it.
int fail_after(const std::string& program, Error error, const std::vector<Finding>& found) {
  std::set<std::string> kinds;
  for (const Finding& finding : found) kinds.insert(finding.kind);
  std::string all;
  for (const std::string& kind : kinds) all += (all.empty() ? "" : ", ") + kind;
  if (!all.empty()) error.hint += "; --dry-run tells more: " + all;
  return fail(program, error);
}

// Errors: those of common_datum and read_check_points.
Result<BuildChecks> checks_of(const std::vector<Drive>& drives, const BuildOptions& options,
                              const std::vector<Finding>& before) {
  BuildChecks checks{before, {}, options.max_check_m};
  if (options.check_points.empty()) return checks;
  const Result<Datum> datum = common_datum(drives);
  if (!datum) return datum.error();
  auto points = read_check_points(options.check_points, options.check_crs, *datum, drives);
  if (!points) return points.error();
  checks.check_points = std::move(*points);
  return checks;
}

// What is wrong with the drives, without mapping them.
int look(const std::string& program, const std::vector<Drive>& drives,
         const BuildOptions& options) {
  if (const Result<Datum> datum = common_datum(drives); !datum) return fail(program, datum.error());
  Result<std::vector<Finding>> findings = drive_findings(drives, options.jobs);
  if (!findings) return fail(program, findings.error());
  const Result<std::vector<Finding>> of_lines = line_findings(drives, options.settings);
  if (of_lines) findings->insert(findings->end(), of_lines->begin(), of_lines->end());
  if (options.json) {
    BuildReport report;
    report.findings = *findings;
    std::cout << json_of(report).dump(2) << "\n";
  } else {
    for (const Finding& finding : *findings) std::cout << error_of(finding).line() << "\n";
  }
  if (!of_lines) return fail(program, of_lines.error());
  if (options.json) return kExitDone;
  std::size_t frames = 0;
  for (const Drive& drive : drives) frames += drive.frames.size();
  std::cout << drives.size() << (drives.size() == 1 ? " drive, " : " drives, ") << frames
            << " frames, " << findings->size() << (findings->size() == 1 ? " finding" : " findings")
            << "; no map was written\n";
  return kExitDone;
}

int build(const std::string& program, BuildOptions options) {
  if (options.map.empty() && !options.dry_run) {
    fail(program, {ErrorCode::invalid_input, "--map", "is required",
                   "name the file to write, or give --dry-run"});
    return kExitWrongCall;
  }
  if (!options.codebook.empty()) {
    Result<PcaProjection> codebook = read_codebook(options.codebook);
    if (!codebook) return fail(program, codebook.error());
    options.settings.codebook = std::move(*codebook);
  }
  Result<std::optional<Division>> division = division_of(options);
  if (!division) return fail(program, division.error());
  options.settings.division = std::move(*division);
  std::vector<Drive> drives;
  for (const std::string& folder : options.drives) {
    Result<Drive> drive = read_drive(folder);
    if (!drive) return fail(program, drive.error());
    drives.push_back(std::move(*drive));
  }
  catch_stop_signals();
  if (options.dry_run) return look(program, drives, options);
  if (const Status free = check_maps_are_free(drives, options); !free) {
    return fail(program, free.error());
  }
  const Result<std::vector<Finding>> before = drive_findings(drives, options.jobs);
  if (!before) return fail(program, before.error());
  const Result<BuildChecks> checks = checks_of(drives, options, *before);
  if (!checks) return fail(program, checks.error());
  const bool is_watched = shows_progress();  // otherwise they are told when the map is written
  if (is_watched) warn_of(program, *before);
  cv::setNumThreads(1);  // one frame per thread uses the cores better than many threads per frame
  Result<BuildReport> report = [&] {
    ProgressLine progress;
    return build_map(
        drives, options.map, options.settings, options.jobs,
        [&](const BuildProgress& at) {
          progress.show("frame " + std::to_string(at.frames_done) + " of " +
                        std::to_string(at.frames_total));
          return !stop_requested();
        },
        *checks);
  }();
  if (!report) return fail_after(program, report.error(), *before);
  if (!is_watched) warn_of(program, *before);
  warn_of(program, report->findings);
  for (const DriveReport& drive : report->drives) {
    if (drive.frames > 0 && drive.tracklets == 0) warn(program, nothing_found(drive));
  }
  if (options.json) {
    report->findings.insert(report->findings.begin(), before->begin(), before->end());
    std::cout << json_of(*report).dump(2) << "\n";
  } else {
    std::cout << text_of(*report);
  }
  return kExitDone;
}

}  // namespace

RunCommand add_build(CLI::App& app) {
  app.description(kBuildDescription);
  const auto options = std::make_shared<BuildOptions>();
  add_build_options(app, *options);
  return [options, program = name_of(app)] { return build(program, *options); };
}

}  // namespace milepost
