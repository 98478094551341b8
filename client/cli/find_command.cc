#include <algorithm>
#include <iostream>
#include <map>

#include "client/cli/commands.h"
#include "client/cli/source_options.h"
#include "client/evaluate/baselines/orientation_filter.h"
#include "client/evaluate/find_errors.h"
#include "client/evaluate/output.h"
#include "client/evaluate/report/find_report_data.h"
#include "client/fetch/walls.h"
#include "schema/base/csv_text.h"
#include "schema/base/digits.h"
#include "schema/base/file.h"
#include "schema/geo/geodesy.h"
#include "schema/page/report_page.h"

namespace milepost {
namespace {

constexpr const char* kFindDescription =
    R"(Finds a vehicle without GNSS among the walls of a map.

It uses the frames and the odometry of the drive; recorded positions and gps.csv are ignored.
Columns: timestamp_s, filename, status (initializing: not found yet; tracking; predicted: propagated by
odometry without a measurement; lost), latitude_deg, longitude_deg and heading_deg of the densest mode,
sigma_m (in each direction; of the whole particle set until the vehicle is found), latency_ms,
mass (probability of that mode) and explained (inlier ratio: the share of recent measurements that
the walls at the mode explain).
Example: milepost-client find --map town.map --drive drives/tuesday --out found.csv)";

const std::map<std::string, GlobalMethod (*)()> kFindMethods = {
    {"orientations", orientations_method}, {"combined", combined_method}};

struct Options {
  SourceOptions source;
  std::string map_name;
  std::vector<double> area_deg;   // west, south, east, north
  std::vector<double> start_deg;  // latitude, longitude
  double start_sigma_m = 15;
  std::optional<double> start_heading_deg;
  std::string drive;
  std::string out;
  std::string localized_out;
  std::string report;
  std::string backdrop;
  std::string method = "combined";
  int particles = 2000;
  int seed = 1;
};

std::string names_of(const std::vector<MapDescription>& maps) {
  std::string names;
  for (const MapDescription& map : maps) {
    names += (names.empty() ? "" : ", ") + map.version.map;
  }
  return names;
}

// The map to search. Errors: not_found if no map of the source has walls, or not the one named;
// invalid_input if several have walls and none is named.
Result<MapDescription> map_to_search(MapSource& source, const Options& options) {
  Result<std::vector<MapDescription>> maps = maps_with_walls(source);
  if (!maps) return maps.error();
  const std::string place = options.source.name();
  if (maps->empty()) {
    return Error{ErrorCode::not_found, place, "no map has the layer walls",
                 "add it with milepost-mapper aerial"};
  }
  if (options.map_name.empty() && maps->size() == 1) return maps->front();
  for (const MapDescription& map : *maps) {
    if (map.version.map == options.map_name) return map;
  }
  if (options.map_name.empty()) {
    return Error{ErrorCode::invalid_input, place, "several maps have walls: " + names_of(*maps),
                 "choose one with --map-name"};
  }
  return Error{ErrorCode::not_found, place,
               "no map '" + options.map_name + "' with walls, but " + names_of(*maps),
               "choose one of these with --map-name"};
}

// The distance outside the area up to which walls are visible.
constexpr double kViewM = RangeSettings{}.reach_m;

std::optional<Bounds> area_of(const Options& options) {
  const auto& area = options.area_deg;
  if (area.empty()) return std::nullopt;
  return Bounds{area[0], area[1], area[2], area[3]};
}

// The walls visible from the area. Errors: those of walls_seen_from; not_found if no wall lies in
// the area.
Result<std::vector<Wall>> walls_to_search(MapSource& source, const MapDescription& map,
                                          const Options& options) {
  const Bounds area = area_of(options).value_or(map.bounds);
  Result<std::vector<Wall>> walls = walls_seen_from(source, map.version, area, kViewM);
  if (!walls) return walls.error();
  const auto is_inside = [&](const Wall& wall) { return bounds_of(wall).meets(area); };
  if (std::ranges::none_of(*walls, is_inside)) {
    return Error{ErrorCode::not_found, "map '" + map.version.map + "'",
                 "there are no walls in the area", "choose another area with --area"};
  }
  return walls;
}

// Errors: those of read_backdrop; invalid_input if the image shows none of the walls.
Result<std::optional<Backdrop>> backdrop_of(const Options& options,
                                            const std::vector<Wall>& walls) {
  if (options.backdrop.empty()) return std::optional<Backdrop>();
  Result<Backdrop> backdrop = read_backdrop(options.backdrop);
  if (!backdrop) return backdrop.error();
  const Bounds box = backdrop->bounds();
  const bool shows_walls = std::any_of(
      walls.begin(), walls.end(), [&](const Wall& wall) { return bounds_of(wall).meets(box); });
  if (shows_walls) return std::optional(std::move(*backdrop));
  return Error{ErrorCode::invalid_input, options.backdrop, "the image shows none of the walls",
               "check its world file or give an image of the area"};
}

// Throws: CLI::ParseError if the options contradict each other.
void check_options(const Options& options) {
  require_source(options.source);
  const std::optional<Bounds> area = area_of(options);
  if (area && (!area->is_valid() || area->crosses_180())) {
    throw CLI::ValidationError("--area",
                               "not a box of west, south, east and north (a box across longitude "
                               "180 is not supported)");
  }
  if (options.start_deg.empty()) return;
  const GeoPoint start{options.start_deg[0], options.start_deg[1], 0};
  if (!is_valid(start)) throw CLI::ValidationError("--start", "not a latitude and longitude");
  const Bounds at_start{start.longitude_deg, start.latitude_deg, start.longitude_deg,
                        start.latitude_deg};
  if (area && !area->meets(at_start))
    throw CLI::ValidationError("--start", "lies outside of --area");
}

GlobalLocalizerSettings localizer_settings(const Options& options) {
  GlobalLocalizerSettings settings;
  settings.method = kFindMethods.at(options.method)();
  settings.particles = static_cast<std::size_t>(options.particles);
  settings.seed = static_cast<std::uint64_t>(options.seed);
  settings.area = area_of(options);
  if (!options.start_deg.empty()) {
    settings.start = PosePrior{{options.start_deg[0], options.start_deg[1], 0},
                               options.start_sigma_m,
                               options.start_heading_deg};
  }
  return settings;
}

std::vector<Output> outputs_of(const Options& options) {
  std::vector<Output> outputs = {{"--out", options.out, &kFixesOutput}};
  if (!options.localized_out.empty()) {
    outputs.push_back({"--localize-out", options.localized_out, &kFixesOutput});
  }
  if (!options.report.empty()) outputs.push_back({"--report", options.report, &kReportOutput});
  return outputs;
}

std::vector<std::filesystem::path> inputs_of(const Drive& drive, const Options& options) {
  std::vector<std::filesystem::path> inputs = inputs_of(drive, options.source);
  if (!options.backdrop.empty()) inputs.emplace_back(options.backdrop);
  return inputs;
}

std::string found_csv(const std::vector<FoundFrame>& frames) {
  CsvText csv(
      "timestamp_s,filename,status,latitude_deg,longitude_deg,heading_deg,sigma_m,latency_ms,"
      "mass,explained");
  for (const FoundFrame& frame : frames) {
    const GlobalPoseEstimate& fix = frame.fix;
    csv.rounded(fix.timestamp_s, 4).cell(frame.filename).cell(name_of(fix.status));
    csv.rounded(fix.position.latitude_deg, 9).rounded(fix.position.longitude_deg, 9);
    csv.rounded(fix.heading_deg, 3).rounded(fix.sigma_m, 3).rounded(frame.latency_ms, 2);
    csv.rounded(fix.mode_probability, 4).rounded(fix.inlier_ratio, 4).end_row();
  }
  return csv.text();
}

std::string summary_line(const std::vector<FoundFrame>& frames, const std::string& out,
                         const Datum& datum) {
  std::size_t tracked = 0;
  std::string since = "the vehicle was not found";
  for (const FoundFrame& frame : frames) {
    if (!is_tracked(frame.fix.status)) continue;
    if (tracked++ > 0) continue;
    since =
        "found after " + fixed(frame.fix.timestamp_s - frames.front().fix.timestamp_s, 1) + " s";
  }
  return out + ": " + since + ", " + std::to_string(tracked) + " of " +
         std::to_string(frames.size()) + " frames tracked" +
         (datum.is_stated() ? ", positions of " + datum.text() : "");
}

void add_options(CLI::App& app, Options& options) {
  add_source_options(app, options.source);
  app.add_option("--drive", options.drive, "Folder of the drive, with an odometry.csv")
      ->required()
      ->option_text("DIR");
  app.add_option("--out", options.out, "File to write the fixes to; old fixes are replaced")
      ->required()
      ->option_text("FILE");
  app.add_option("--map-name", options.map_name, "Which map to search, if several have walls")
      ->option_text("NAME");
  app.add_option("--area", options.area_deg,
                 "Box in WGS84 degrees that contains the vehicle (default: the whole map)")
      ->expected(4)
      ->delimiter(',')
      ->option_text("W,S,E,N");
  CLI::Option* start = app.add_option("--start", options.start_deg,
                                      "Initial position of the vehicle (default: unknown)")
                           ->expected(2)
                           ->delimiter(',')
                           ->option_text("LAT,LON");
  add_number(app, "--start-sigma-m", options.start_sigma_m, "M",
             "Standard deviation of the initial position, per axis", 0.1, 1000)
      ->needs(start);
  app.add_option("--start-heading-deg", options.start_heading_deg,
                 "Initial heading, clockwise from north, with a standard deviation of 10 degrees\n"
                 "(-360 to 360)")
      ->check(CLI::Range(-360.0, 360.0))
      ->needs(start)
      ->option_text("DEG");
  app.add_option("--method", options.method,
                 "orientations: wall orientations by bearing, weighted as in the aerial paper;\n"
                 "combined: these and ranges to triangulated points, matched with walls (default)")
      ->check(CLI::IsMember(kFindMethods))
      ->option_text("M");
  add_number(app, "--particles", options.particles, "N", "Particles of the filter", 10, 1000000);
  add_number(app, "--seed", options.seed, "N", "Seed of the filter's random numbers", 0, 1000000);
  app.add_option("--localize-out", options.localized_out,
                 "Also localize along the mapped roads, starting from the global fixes, and write\n"
                 "these fixes")
      ->option_text("FILE");
  CLI::Option* report =
      app.add_option("--report", options.report,
                     "Also write an HTML report of the run: the belief at several times, the\n"
                     "path, errors over time; only the report uses the recorded positions")
          ->option_text("FILE.html");
  app.add_option("--backdrop", options.backdrop,
                 "Background image for the report's plans: PNG or JPEG with a world file in\n"
                 "WGS84 degrees next to it, as made from an orthoimage by\n"
                 "gdalwarp -t_srs EPSG:4326 and gdal_translate -of JPEG -co WORLDFILE=YES")
      ->needs(report)
      ->option_text("IMAGE");
}

int find(const std::string& program, const Options& options) {
  const Result<Drive> drive = read_drive(options.drive);
  if (!drive) return fail(program, drive.error());
  if (const Status free = check_outputs(outputs_of(options), inputs_of(*drive, options)); !free) {
    return fail(program, free.error());
  }
  const Result<std::shared_ptr<MapSource>> source = open_source(options.source);
  if (!source) return fail(program, source.error());
  const Result<MapDescription> map = map_to_search(**source, options);
  if (!map) return fail(program, map.error());
  if (!options.report.empty()) {
    const Status same = check_agree(drive->datum, (drive->folder / "drive.json").string(),
                                    map->datum, "map '" + map->version.map + "'");
    if (!same) return fail(program, same.error());
  }
  const Result<std::vector<Wall>> walls = walls_to_search(**source, *map, options);
  if (!walls) return fail(program, walls.error());
  const Result<std::optional<Backdrop>> backdrop = backdrop_of(options, *walls);
  if (!backdrop) return fail(program, backdrop.error());
  FindRecorder recorder;
  catch_stop_signals();
  const Result<FoundDrive> found = [&] {
    ProgressLine progress;
    FindRun run;
    run.localizer = localizer_settings(options);
    if (!options.localized_out.empty()) run.localizer_source = *source;
    run.stopped = stop_requested;
    run.on_frame = [&](std::size_t frame, const GlobalPoseEstimate& fix,
                       const GlobalLocalizer& localizer) {
      recorder.observe(frame, fix.status, localizer);
      progress.show("frame " + std::to_string(frame + 1) + " of " +
                    std::to_string(drive->frames.size()));
      return !stop_requested();
    };
    return find_drive(*drive, *walls, run);
  }();
  if (!found) return fail(program, found.error());
  Status written = write_text_file(options.out, found_csv(found->frames));
  if (written.ok() && !options.localized_out.empty()) {
    written = write_text_file(options.localized_out, fixes_csv(found->localized));
  }
  if (written.ok() && !options.report.empty()) {
    FindReportInput input;
    input.map_name = map->version.map + " (build " + map->version.build + ")";
    input.map_source = options.source.name();
    input.settings = options.method + ", " + std::to_string(options.particles) +
                     " particles, seed " + std::to_string(options.seed);
    input.drive = &*drive;
    input.frames = &found->frames;
    input.recorder = &recorder;
    input.backdrop = *backdrop;
    written = write_text_file(options.report, report_page(find_report_data(input)));
  }
  if (!written.ok()) return fail(program, written.error());
  report_stream(options.out) << summary_line(found->frames, options.out, map->datum) << "\n";
  return found->outage ? fail(program, *found->outage) : kExitDone;
}

}  // namespace

RunCommand add_find(CLI::App& app) {
  app.description(kFindDescription);
  const auto options = std::make_shared<Options>();
  add_options(app, *options);
  app.callback([options] { check_options(*options); });
  return [options, program = name_of(app)] { return find(program, *options); };
}

}  // namespace milepost
