#include <iostream>
#include <map>

#include "client/cli/cells.h"
#include "client/cli/commands.h"
#include "client/cli/find_drive.h"
#include "client/cli/output.h"
#include "client/cli/source_options.h"
#include "client/fetch/walls.h"
#include "schema/base/file.h"

namespace milepost {
namespace {

const std::map<std::string, FindMethod> kMethods = {{"orientations", FindMethod::orientations},
                                                    {"ranges", FindMethod::ranges}};

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
  std::string method = "ranges";
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

// Errors: those of map_to_search and walls_in; not_found where the area has none.
Result<std::vector<Wall>> walls_to_search(MapSource& source, const Options& options) {
  const Result<MapDescription> map = map_to_search(source, options);
  if (!map) return map.error();
  const auto& area = options.area_deg;
  const Bounds box = area.empty() ? map->bounds : Bounds{area[0], area[1], area[2], area[3]};
  Result<std::vector<Wall>> walls = walls_in(source, map->version, kWallsLayer, box);
  if (!walls) return walls.error();
  std::erase_if(*walls, [&](const Wall& wall) { return !bounds_of(wall).meets(box); });
  if (walls->empty()) {
    return Error{ErrorCode::not_found, "map '" + map->version.map + "'",
                 "there are no walls in the area", "choose another area by --area"};
  }
  return walls;
}

FinderSettings finder_settings(const Options& options, bool has_heading) {
  FinderSettings settings;
  settings.method = kMethods.at(options.method);
  settings.particles = static_cast<std::size_t>(options.particles);
  settings.seed = static_cast<std::uint64_t>(options.seed);
  if (!options.start_deg.empty()) {
    settings.start = FindStart{
        {options.start_deg[0], options.start_deg[1], 0}, options.start_sigma_m, std::nullopt};
    if (has_heading) settings.start->heading_deg = options.start_heading_deg;
  }
  return settings;
}

std::string found_csv(const std::vector<FoundFrame>& frames) {
  std::string text =
      "timestamp_s,filename,status,latitude_deg,longitude_deg,heading_deg,sigma_m,latency_ms,"
      "mass,explained\n";
  for (const FoundFrame& frame : frames) {
    const FindFix& fix = frame.fix;
    text += number(fix.timestamp_s, 4) + "," + frame.filename + "," + name_of(fix.status) + "," +
            number(fix.position.latitude_deg, 9) + "," + number(fix.position.longitude_deg, 9) +
            "," + number(fix.heading_deg, 3) + "," + number(fix.sigma_m, 3) + "," +
            number(frame.latency_ms, 2) + "," + number(fix.mass, 4) + "," +
            number(fix.explained, 4) + "\n";
  }
  return text;
}

std::string summary_line(const std::vector<FoundFrame>& frames, const std::string& out) {
  std::size_t tracked = 0;
  std::string since = "the vehicle was not found";
  for (const FoundFrame& frame : frames) {
    if (frame.fix.status != FindStatus::tracking && frame.fix.status != FindStatus::predicted) {
      continue;
    }
    if (tracked++ > 0) continue;
    since =
        "found after " + number(frame.fix.timestamp_s - frames.front().fix.timestamp_s, 1) + " s";
  }
  return out + ": " + since + ", " + std::to_string(tracked) + " of " +
         std::to_string(frames.size()) + " frames tracked";
}

void add_options(CLI::App& app, Options& options) {
  add_source_options(app, options.source);
  app.add_option("--drive", options.drive, "Folder of the drive; it has an odometry.csv")
      ->required()
      ->option_text("DIR");
  app.add_option("--out", options.out, "File to write the fixes to")
      ->required()
      ->option_text("FILE");
  app.add_option("--map-name", options.map_name, "Which map, where several have walls")
      ->option_text("NAME");
  app.add_option("--area", options.area_deg, "Only the walls in this box of WGS84 degrees")
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
                 "ranges: points that the moving camera saw, looked for on the walls (default);\n"
                 "orientations: orientations of walls by bearing, as published")
      ->check(CLI::IsMember(kMethods))
      ->option_text("M");
  add_number(app, "--particles", options.particles, "N", "Particles of the filter", 10, 1000000);
  add_number(app, "--seed", options.seed, "N", "Seed of the filter's random numbers", 0, 1000000);
  app.add_option("--localize-out", options.localized_out,
                 "Also localize along the mapped roads, starting from what is found, and write\n"
                 "these fixes")
      ->option_text("FILE");
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
  if (options.source.server.empty() && options.source.map.empty()) {
    std::cerr << program << ": either --server or --map is required; see '" << program
              << " --help'\n";
    return kExitWrongCall;
  }

  const Result<Drive> drive = read_drive(options.drive);
  if (!drive) return fail(program, drive.error());
  const Result<std::shared_ptr<MapSource>> source = open_source(options.source);
  if (!source) return fail(program, source.error());
  const Result<std::vector<Wall>> walls = walls_to_search(**source, options);
  if (!walls) return fail(program, walls.error());
  catch_stop_signals();
  const Result<FoundDrive> found = [&] {
    ProgressLine progress;
    FindRun run;
    run.finder = finder_settings(options, app.count("--start-heading-deg") > 0);
    if (!options.localized_out.empty()) run.localizer_source = *source;
    run.on_frame = [&](std::size_t frame, const Finder&) {
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
  if (!written.ok()) return fail(program, written.error());
  std::cout << summary_line(found->frames, options.out) << "\n";
  return kExitDone;
}

}  // namespace milepost
