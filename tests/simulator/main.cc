// milepost-simulator: generates a town and records drives and an orthoimage of it.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "schema/base/output_file.h"
#include "schema/command/command.h"
#include "schema/drive/checks.h"
#include "tests/simulator/aerial.h"
#include "tests/simulator/city.h"
#include "tests/simulator/city_graph.h"
#include "tests/simulator/city_runs.h"
#include "tests/simulator/record.h"
#include "tests/simulator/runs.h"
#include "tests/simulator/town.h"

namespace {

using namespace milepost;
using namespace milepost::simulator;

constexpr const char* kProgram = "milepost-simulator";

constexpr const char* kDescription =
    "Makes up a town from a seed and drives through it: roads with junctions, a hill and a\n"
    "roundabout, houses, trees, traffic, sun and shadows. Writes drive folders, an orthoimage and\n"
    "the true outlines of the houses. The same seed and options give the same bytes.\n"
    "\n"
    "With --city it makes up a city instead: a network of roads with a bridge, an exit, a\n"
    "roundabout and a dual carriageway. Drives city-1-map, ... map it; city-1-tour, ... pass its\n"
    "junctions in every mapped way; the last tour leaves the map, if the city is not small.\n"
    "city-graph.json states the true junctions and roads. Options on positions rewrite a city's\n"
    "tables, not its frames.\n"
    "\n"
    "  milepost-simulator --out drives                      every drive of the town's three "
    "routes\n"
    "  milepost-simulator --out drives --route town-loop    one route: its map and query drives\n"
    "  milepost-simulator --out drives --route street --length-m 60     a short street, quickly\n"
    "  milepost-simulator --ortho town.tif --walls town.geojson         the town from the air\n"
    "  milepost-simulator --out drives --city --small                   a small city\n"
    "  milepost-simulator --out drives --city --drive city-1-map city-1-tour\n"
    "  milepost-simulator --out drives --city --position-drift-m 0.3    other positions, quickly\n"
    "\n"
    "A route NAME gives drives NAME-map (a frame each 2 m) and NAME-query...; --list names them.";

struct Options {
  std::string out;
  std::vector<std::string> routes;
  std::vector<std::string> drives;
  double length_m = 10000;
  std::uint64_t seed = 1;
  std::vector<int> size_px = {600, 500};
  std::vector<double> view_deg = {80, 64};
  std::string lens = "pinhole";
  std::vector<double> distortion;
  std::vector<double> mounting;
  bool record_tilts = false;
  double map_spacing_m = 2;
  PositionErrors errors;
  bool city = false;
  bool small = false;
  bool fleet = false;
  std::string ortho;
  std::string walls;
  int threads = 0;
  bool list = false;
};

void add_options(CLI::App& app, Options& options) {
  app.add_option("--out", options.out, "Folder for the drives; made if need be")
      ->option_text("DIR");
  app.add_flag("--city", options.city, "A city and its drives and tours instead of the town");
  app.add_flag("--small", options.small, "With --city: 400 m of road and two junctions, quickly");
  app.add_flag("--fleet", options.fleet,
               "With --city: six drives and a tour on one road, in other lanes, light and traffic");
  app.add_option("--route", options.routes, "Only the drives of these routes")
      ->option_text("NAME...");
  app.add_option("--drive", options.drives, "Only these drives")->option_text("NAME...");
  app.add_flag("--list", options.list, "List routes and drives, and write nothing");
  add_number(app, "--length-m", options.length_m, "M", "At most this much of each route", 10,
             10000);
  app.add_option("--seed", options.seed, "Seed of the town and of all noise (default 1)")
      ->option_text("N");
  app.add_option("--camera-px", options.size_px,
                 "Width and height of the frames (16 to 8192, default 600 500)")
      ->expected(2)
      ->check(CLI::Range(16, 8192))
      ->option_text("W H");
  app.add_option("--view-deg", options.view_deg,
                 "Horizontal and vertical angle of view (5 to 150, default 80 64)")
      ->expected(2)
      ->check(CLI::Range(5.0, 150.0))
      ->option_text("H V");
  app.add_option("--lens", options.lens,
                 "pinhole, brown-conrady or kannala-brandt; --view-deg is of a pinhole of the same "
                 "focal length (default pinhole)")
      ->check(CLI::IsMember({"pinhole", "brown-conrady", "kannala-brandt"}))
      ->option_text("MODEL");
  app.add_option("--distortion", options.distortion,
                 "Its coefficients in OpenCV's order: k1 k2 p1 p2 k3 ..., or k1 k2 k3 k4")
      ->expected(1, 8)
      ->option_text("K...");
  app.add_option("--mounting", options.mounting,
                 "The camera's place on its vehicle: metres forward, to the right and up of the "
                 "reference point, whose positions are recorded; degrees of yaw, pitch and roll")
      ->expected(6)
      ->option_text("F R U YAW PITCH ROLL");
  app.add_flag("--record-tilts", options.record_tilts, "Record the vehicle's pitch and roll");
  add_number(app, "--map-spacing-m", options.map_spacing_m, "M",
             "Distance between the frames of the map drives", 0.1, 100);
  add_number(app, "--position-noise-m", options.errors.noise_m, "M",
             "Standard deviation, on each axis, of the map drives' positions; in a city from frame "
             "to frame, in the town over some 15 m",
             0, 20);
  add_number(app, "--position-drift-m", options.errors.drift_m, "M",
             "The same of errors that change over 100 to 300 m", 0, 20);
  add_number(app, "--position-bias-m", options.errors.bias_m, "M",
             "The same of errors that are constant in a drive", 0, 20);
  add_number(app, "--heading-noise-deg", options.errors.heading_deg, "DEG",
             "Standard deviation of the map drives' headings, from frame to frame", 0, 45);
  app.add_option("--ortho", options.ortho, "GeoTIFF of the town, 10 cm a pixel")
      ->option_text("FILE");
  app.add_option("--walls", options.walls, "GeoJSON of the houses' outlines")->option_text("FILE");
  app.add_option("--threads", options.threads,
                 "Threads; the result does not depend on it (1 to 256, default one a core)")
      ->check(CLI::Range(1, 256))
      ->option_text("N");
}

// A pinhole.
Camera plain_camera_of(const Options& options) {
  const auto focal = [](int pixels, double view_deg) {
    return pixels / 2.0 / std::tan(view_deg * CV_PI / 360);
  };
  const int width = options.size_px[0];
  const int height = options.size_px[1];
  const bool is_paper =
      width == 600 && height == 500 && options.view_deg[0] == 80 && options.view_deg[1] == 64;
  if (is_paper) return kPaperCamera;
  return {width,
          height,
          {focal(width, options.view_deg[0]), focal(height, options.view_deg[1]), width / 2.0,
           height / 2.0}};
}

// Errors: invalid_input (a lens that is none).
Result<Camera> camera_of(const Options& options) {
  Camera camera = plain_camera_of(options);
  Result<Lens> lens = Lens::make(*lens_model_named(options.lens), options.distortion);
  if (!lens) {
    return Error{ErrorCode::invalid_input, "--distortion", lens.error().what, lens.error().hint};
  }
  camera.lens = std::move(*lens);
  if (const std::vector<double>& m = options.mounting; !m.empty())
    camera.mounting = {m[0], m[1], m[2], m[3], m[4], m[5]};
  if (const Status status = check_camera(camera, "--mounting"); !status) return status.error();
  return camera;
}

template <class T>
bool holds(const std::vector<T>& values, const T& value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

// The requested runs. Errors: invalid_input for an unknown name.
Result<std::vector<RunPlan>> chosen_runs(const Options& options, const std::vector<RunPlan>& all) {
  for (const auto& [names, member, what] : {std::tuple{&options.routes, &RunPlan::route, "route"},
                                            std::tuple{&options.drives, &RunPlan::name, "drive"}}) {
    for (const std::string& name : *names) {
      const bool is_known =
          std::any_of(all.begin(), all.end(),
                      [&, member = member](const RunPlan& run) { return run.*member == name; });
      if (!is_known) {
        return Error{ErrorCode::invalid_input, std::string("--") + what,
                     "there is no " + std::string(what) + " '" + name + "'",
                     "choose one that --list names"};
      }
    }
  }
  const Result<Camera> camera = camera_of(options);
  if (!camera) return camera.error();
  std::vector<RunPlan> runs;
  const bool is_any = options.routes.empty() && options.drives.empty();
  for (RunPlan run : all) {
    const bool is_chosen =
        is_any ? options.city || is_driven_by_default(run.route)
               : holds(options.routes, run.route) || holds(options.drives, run.name);
    if (!is_chosen) continue;
    run.camera = *camera;
    run.records_tilts = options.record_tilts;
    if (run.spacing_m > 0) {  // the mapping drive
      run.spacing_m = options.map_spacing_m;
      run.errors = options.errors;
      if (!options.city) run.position_noise_m = std::exchange(run.errors.noise_m, 0);
    }
    runs.push_back(std::move(run));
  }
  return runs;
}

Progress progress_on(ProgressLine& line, const std::string& name, const std::string& unit) {
  return [&line, name, unit](std::size_t done, std::size_t count) {
    line.show(name + ": " + unit + " " + std::to_string(done) + " of " + std::to_string(count));
    return !stop_requested();
  };
}

// What is driven in: the town, or a city.
struct World {
  std::optional<City> city;
  Network network;
  std::vector<RunPlan> runs;

  explicit World(const Options& options) {
    if (!options.city) {
      network = make_network(options.seed);
      runs = make_runs(network, options.seed, options.length_m);
      return;
    }
    city = make_city(options.seed, options.small   ? CityPlan::small
                                   : options.fleet ? CityPlan::fleet
                                                   : CityPlan::full);
    network = city->network;
    runs = city_runs(*city, options.length_m);
  }

  Town build(std::uint64_t seed, GroundDetail detail) const {
    Town town = build_town(network, seed, detail);
    if (city) town.kind = "city";
    return town;
  }
};

Status record_one(const Town& town, const RunPlan& run, const std::filesystem::path& folder,
                  int threads, ProgressLine& line) {
  if (has_recorded(town, run, folder)) return record_tables(town, run, folder);
  const Lighting lighting = light_town(town, run.light);
  return record(town, lighting, run, folder, threads, progress_on(line, run.name, "frame"));
}

Status record_all(const Options& options, const World& world, const std::vector<RunPlan>& runs,
                  int threads) {
  const std::filesystem::path out = options.out;
  const Town town = world.build(options.seed, GroundDetail::road);
  ProgressLine line;
  for (const RunPlan& run : runs) {
    const Status status = record_one(town, run, out / run.name, threads, line);
    if (!status) return status;
  }
  return world.city ? write_city_graph(*world.city, out / kCityGraphFile) : ok_status();
}

Status photograph(const Options& options, const World& world, int threads) {
  if (options.ortho.empty() && options.walls.empty()) return ok_status();
  const Town town = world.build(options.seed, GroundDetail::aerial);
  if (!options.walls.empty()) {
    if (const Status status = write_walls(town, options.walls); !status) return status;
  }
  if (options.ortho.empty()) return ok_status();
  ProgressLine line;
  return write_orthoimage(town, light_town(town, morning_light()), ortho_of(town.network),
                          options.ortho, threads, progress_on(line, options.ortho, "row"));
}

bool begins_tiff(std::string_view head) {
  return head.starts_with(std::string_view("II*\0", 4)) || head.starts_with("II+");
}

constexpr OutputKind kOrthoimageOutput = {"a TIFF image", begins_tiff, false};

Status check_files(const Options& options) {
  std::vector<Output> outputs;
  if (!options.ortho.empty()) outputs.push_back({"--ortho", options.ortho, &kOrthoimageOutput});
  if (!options.walls.empty()) outputs.push_back({"--walls", options.walls, &kGeoJsonOutput});
  return check_outputs(outputs, {});
}

void list(const std::vector<RunPlan>& runs) {
  for (const RunPlan& run : runs) {
    std::cout << run.route << "  " << run.name << "  "
              << std::lround(run.motion.to_m - run.motion.from_m) << " m: " << run.says << "\n";
  }
}

int run(const Options& options) {
  const World world(options);
  if (options.list) {
    list(world.runs);
    return kExitDone;
  }
  const auto runs = chosen_runs(options, world.runs);
  if (!runs) {
    fail(kProgram, runs.error());
    return kExitWrongCall;
  }
  if (const Status free = check_files(options); !free) return fail(kProgram, free.error());
  cv::setNumThreads(1);  // one picture per thread
  const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const int threads = options.threads > 0 ? options.threads : cores;
  catch_stop_signals();
  if (!options.out.empty()) {
    if (const Status status = record_all(options, world, *runs, threads); !status) {
      return fail(kProgram, status.error());
    }
  }
  if (const Status status = photograph(options, world, threads); !status) {
    return fail(kProgram, status.error());
  }
  return kExitDone;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(kDescription, kProgram);
  add_options(app, options);
  app.callback([&options] {
    const bool writes = !options.out.empty() || !options.ortho.empty() || !options.walls.empty();
    if (!options.list && !writes) throw CLI::RequiredError("--out, --ortho or --walls");
    if (options.small && !options.city) throw CLI::RequiresError("--small", "--city");
    if (options.fleet && !options.city) throw CLI::RequiresError("--fleet", "--city");
    if (options.fleet && options.small) throw CLI::ExcludesError("--fleet", "--small");
  });
  if (const auto exit_code = parse_command_line(app, argc, argv)) return *exit_code;
  return run(options);
}
