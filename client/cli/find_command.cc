#include <algorithm>
#include <iostream>
#include <map>

#include "client/cli/commands.h"
#include "client/cli/source_options.h"
#include "client/evaluate/baselines/orientation_filter.h"
#include "client/evaluate/find_errors.h"
#include "client/evaluate/output.h"
#include "client/evaluate/report/find_report_data.h"
#include "client/evaluate/report/report_page.h"
#include "client/fetch/walls.h"
#include "schema/base/csv_text.h"
#include "schema/base/digits.h"
#include "schema/base/file.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

const std::map<std::string, FindMethod (*)()> kMethods = {{"orientations", orientations_method},
                                                          {"combined", combined_method}};

struct Options {
  SourceOptions source;
  std::string map_name;
  std::vector<double> area_deg;   // west, south, east, north
  std::vector<double> start_deg;  // latitude, longitude
  double start_sigma_m = 15;
  double start_heading_deg = 0;
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

// The map to look in. Errors: not_found where none of the source has walls, or not the one named;
// invalid_input where there are several.
Result<MapDescription> map_to_search(MapSource& source, const Options& options) {
  Result<std::vector<MapDescription>> maps = maps_with_walls(source);
  if (!maps) return maps.error();
  const std::string place = options.source.name();
  if (maps->empty()) {
    return Error{ErrorCode::not_found, place, "no map has the layer walls",
                 "add it by milepost-mapper aerial"};
  }
  if (options.map_name.empty() && maps->size() == 1) return maps->front();
  for (const MapDescription& map : *maps) {
    if (map.version.map == options.map_name) return map;
  }
  if (options.map_name.empty()) {
    return Error{ErrorCode::invalid_input, place, "several maps have walls: " + names_of(*maps),
                 "choose one by --map-name"};
  }
  return Error{ErrorCode::not_found, place,
               "no map '" + options.map_name + "' with walls, but " + names_of(*maps),
               "choose one of these by --map-name"};
}

// How far outside of its area a vehicle sees walls.
constexpr double kViewM = RangeSettings{}.reach_m;

std::optional<Bounds> area_of(const Options& options) {
  const auto& area = options.area_deg;
  if (area.empty()) return std::nullopt;
  return Bounds{area[0], area[1], area[2], area[3]};
}

// The walls that are seen from the area. Errors: those of walls_seen_from; not_found where the area
// has none.
Result<std::vector<Wall>> walls_to_search(MapSource& source, const MapDescription& map,
                                          const Options& options) {
  const Bounds area = area_of(options).value_or(map.bounds);
  Result<std::vector<Wall>> walls = walls_seen_from(source, map.version, area, kViewM);
  if (!walls) return walls.error();
  const auto is_inside = [&](const Wall& wall) { return bounds_of(wall).meets(area); };
  if (std::ranges::none_of(*walls, is_inside)) {
    return Error{ErrorCode::not_found, "map '" + map.version.map + "'",
                 "there are no walls in the area", "choose another area by --area"};
  }
  return walls;
}

// Errors: those of read_backdrop; invalid_input for a picture of another place.
Result<std::optional<Backdrop>> backdrop_of(const Options& options,
                                            const std::vector<Wall>& walls) {
  if (options.backdrop.empty()) return std::optional<Backdrop>();
  Result<Backdrop> backdrop = read_backdrop(options.backdrop);
  if (!backdrop) return backdrop.error();
  const Bounds box = backdrop->bounds();
  const bool shows_walls = std::any_of(
      walls.begin(), walls.end(), [&](const Wall& wall) { return bounds_of(wall).meets(box); });
  if (shows_walls) return std::optional(std::move(*backdrop));
  return Error{ErrorCode::invalid_input, options.backdrop, "the picture shows none of the walls",
               "check its world file or give a picture of the area"};
}

// What of the options cannot be meant, where something cannot.
std::optional<std::string> wrong_call(const Options& options) {
  if (options.source.server.empty() && options.source.map.empty()) {
    return "either --server or --map is required";
  }
  const std::optional<Bounds> area = area_of(options);
  if (area && (!area->is_valid() || area->crosses_180())) {
    return "--area is no box of west, south, east and north (one across longitude 180 cannot be "
           "given)";
  }
  if (options.start_deg.empty()) return std::nullopt;
  const GeoPoint start{options.start_deg[0], options.start_deg[1], 0};
  if (!is_valid(start)) return "--start is no latitude and longitude";
  const Bounds about_start{start.longitude_deg, start.latitude_deg, start.longitude_deg,
                           start.latitude_deg};
  if (area && !area->meets(about_start)) {
    return "--start lies outside of --area";
  }
  return std::nullopt;
}

FinderSettings finder_settings(const Options& options, bool has_heading) {
  FinderSettings settings;
  settings.method = kMethods.at(options.method)();
  settings.particles = static_cast<std::size_t>(options.particles);
  settings.seed = static_cast<std::uint64_t>(options.seed);
  settings.area = area_of(options);
  if (!options.start_deg.empty()) {
    settings.start = FindStart{
        {options.start_deg[0], options.start_deg[1], 0}, options.start_sigma_m, std::nullopt};
    if (has_heading) settings.start->heading_deg = options.start_heading_deg;
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
    const FindFix& fix = frame.fix;
    csv.rounded(fix.timestamp_s, 4).cell(frame.filename).cell(name_of(fix.status));
    csv.rounded(fix.position.latitude_deg, 9).rounded(fix.position.longitude_deg, 9);
    csv.rounded(fix.heading_deg, 3).rounded(fix.sigma_m, 3).rounded(frame.latency_ms, 2);
    csv.rounded(fix.mass, 4).rounded(fix.explained, 4).end_row();
  }
  return csv.text();
}

std::string summary_line(const std::vector<FoundFrame>& frames, const std::string& out) {
  std::size_t tracked = 0;
  std::string since = "the vehicle was not found";
  for (const FoundFrame& frame : frames) {
    if (!is_tracked(frame.fix.status)) continue;
    if (tracked++ > 0) continue;
    since =
        "found after " + fixed(frame.fix.timestamp_s - frames.front().fix.timestamp_s, 1) + " s";
  }
  return out + ": " + since + ", " + std::to_string(tracked) + " of " +
         std::to_string(frames.size()) + " frames tracked";
}

void add_options(CLI::App& app, Options& options) {
  add_source_options(app, options.source);
  app.add_option("--drive", options.drive, "Folder of the drive; it has an odometry.csv")
      ->required()
      ->option_text("DIR");
  app.add_option("--out", options.out, "File to write the fixes to; old fixes are replaced")
      ->required()
      ->option_text("FILE");
  app.add_option("--map-name", options.map_name, "Which map, where several have walls")
      ->option_text("NAME");
  app.add_option("--area", options.area_deg,
                 "Box of WGS84 degrees that the vehicle is in (default: all of the map)")
      ->expected(4)
      ->delimiter(',')
      ->option_text("W,S,E,N");
  CLI::Option* start = app.add_option("--start", options.start_deg,
                                      "Where the vehicle is at first (default: anywhere)")
                           ->expected(2)
                           ->delimiter(',')
                           ->option_text("LAT,LON");
  add_number(app, "--start-sigma-m", options.start_sigma_m, "M",
             "Standard deviation of that, in each direction", 0.1, 1000)
      ->needs(start);
  add_number(app, "--start-heading-deg", options.start_heading_deg, "DEG",
             "Its heading then, clockwise from north, within 10 degrees", -360, 360)
      ->needs(start);
  app.add_option("--method", options.method,
                 "orientations: orientations of walls by bearing, the aerial paper's importance;\n"
                 "combined: these, and points that the moving camera saw, looked for on the walls\n"
                 "(default)")
      ->check(CLI::IsMember(kMethods))
      ->option_text("M");
  add_number(app, "--particles", options.particles, "N", "Particles of the filter", 10, 1000000);
  add_number(app, "--seed", options.seed, "N", "Seed of the filter's random numbers", 0, 1000000);
  app.add_option("--localize-out", options.localized_out,
                 "Also localize along the mapped roads, starting from what is found, and write\n"
                 "these fixes")
      ->option_text("FILE");
  CLI::Option* report =
      app.add_option("--report", options.report,
                     "Also write a page about the run: the belief at several times, the path, "
                     "errors\nover time; it alone compares with the recorded positions")
          ->option_text("FILE.html");
  app.add_option("--backdrop", options.backdrop,
                 "Picture of the area for the report's plans: PNG or JPEG with a world file in\n"
                 "WGS84 degrees beside it, as made of an orthoimage by\n"
                 "gdalwarp -t_srs EPSG:4326 and gdal_translate -of JPEG -co WORLDFILE=YES")
      ->needs(report)
      ->option_text("IMAGE");
}

}  // namespace

int run_find(const std::string& program, std::vector<std::string> words) {
  CLI::App app(
      "Finds a vehicle without any receiver among the walls of a map's area, from the frames and "
      "the\n"
      "odometry of its drive; recorded positions and gps.csv are not looked at.\n\n"
      "Columns: timestamp_s, filename, status (initializing: nothing is found yet; tracking; "
      "predicted:\n"
      "carried on by the wheels; lost), latitude_deg, longitude_deg and heading_deg where the "
      "belief is\n"
      "densest, sigma_m (in each direction; while nothing is found, of the whole belief), "
      "latency_ms; then\n"
      "mass (part of the belief that lies there) and explained (share of what was seen lately that "
      "the walls\n"
      "there explain).\n"
      "Example: milepost-client find --map town.map --drive drives/tuesday --out found.csv",
      program);
  Options options;
  add_options(app, options);
  if (const auto code = parse_words(app, std::move(words))) return *code;
  if (const auto wrong = wrong_call(options)) {
    std::cerr << program << ": " << *wrong << "; see '" << program << " --help'\n";
    return kExitWrongCall;
  }

  const Result<Drive> drive = read_drive(options.drive);
  if (!drive) return fail(program, drive.error());
  if (const Status free = check_outputs(outputs_of(options), inputs_of(*drive, options)); !free) {
    return fail(program, free.error());
  }
  const Result<std::shared_ptr<MapSource>> source = open_source(options.source);
  if (!source) return fail(program, source.error());
  const Result<MapDescription> map = map_to_search(**source, options);
  if (!map) return fail(program, map.error());
  const Result<std::vector<Wall>> walls = walls_to_search(**source, *map, options);
  if (!walls) return fail(program, walls.error());
  const Result<std::optional<Backdrop>> backdrop = backdrop_of(options, *walls);
  if (!backdrop) return fail(program, backdrop.error());
  FindRecorder recorder;
  catch_stop_signals();
  const Result<FoundDrive> found = [&] {
    ProgressLine progress;
    FindRun run;
    run.finder = finder_settings(options, app.count("--start-heading-deg") > 0);
    if (!options.localized_out.empty()) run.localizer_source = *source;
    run.stopped = stop_requested;
    run.on_frame = [&](std::size_t frame, const FindFix& fix, const Finder& finder) {
      recorder.observe(frame, fix.status, finder);
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
  report_stream(options.out) << summary_line(found->frames, options.out) << "\n";
  return found->outage ? fail(program, *found->outage) : kExitDone;
}

}  // namespace milepost
