#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <thread>

#include <opencv2/core/utility.hpp>

#include "mapper/aerial/coverage.h"
#include "mapper/aerial/extraction.h"
#include "mapper/aerial/footprints.h"
#include "mapper/aerial/storable_walls.h"
#include "mapper/aerial/wall_layer.h"
#include "mapper/cli/commands.h"
#include "schema/base/digits.h"
#include "schema/command/command.h"

namespace milepost {
namespace fs = std::filesystem;
namespace {

constexpr const char* kAerialDescription =
    R"(Extracts the walls of buildings from aerial data into a map.

A vehicle is localized by them without GNSS (milepost-client find).
With --image an orthoimage of any projection that GDAL reads is processed; its pixels are
of at most 1.2 m on the ground, its corners within 100 km of the middle. Edges are detected at
several thresholds, without the borders of shadows on the ground and without
vegetation; then lines, the longest first; roofs, by shape, shadow and the colours of the
image's own clearest roofs, and the lines at their edges; then segments of one line are
merged, and lines that meet no other at either end are dropped.
With --footprints the outlines of a GeoJSON file (WGS84), as OpenStreetMap has them, become
walls, and the image, if there is one, adds those that they do not cover.
A wall across longitude 180 is split there.
An existing map keeps its segments and other layers, its walls are replaced; the file is
changed on success only, and not if no wall was found.
Example: milepost-mapper aerial --image town.tif --map maps/town.map
         milepost-mapper aerial --footprints town.geojson --map maps/town.map)";

constexpr const char* kWallSettings = "Settings (each changes the walls)";
constexpr double kImageSigmaM = 0.4;      // r.m.s. error of walls within 1 m of a true outline
constexpr double kFootprintSigmaM = 0.5;  // OpenStreetMap's are digitized by hand on images

const std::map<std::string, Stage> kStages = {
    {"closure", Stage::closure},         {"corners", Stage::corners}, {"merging", Stage::merging},
    {"progressive", Stage::progressive}, {"roofs", Stage::roofs},     {"shadows", Stage::shadows},
    {"vegetation", Stage::vegetation}};

struct AerialOptions {
  ImageSource image;
  std::string footprints;
  std::string map;
  std::string debug_images;
  std::vector<std::string> without;  // names of stages
  bool allow_empty = false;
  int jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  ExtractionSettings settings;
};

void add_aerial_options(CLI::App& app, AerialOptions& options) {
  app.add_option("--image", options.image.file, "Orthoimage to find walls in")->option_text("FILE");
  app.add_option("--image-crs", options.image.reference,
                 "Coordinate reference system of an image that does not state it: EPSG:3857")
      ->option_text("CRS");
  app.add_option("--bands", options.image.bands,
                 "Bands of the image to use, counted from 1: one of grey or three of "
                 "red,\n"
                 "green and blue, and after them one of transparency, if it has one (default: what "
                 "the\n"
                 "image's tags say; a band that is tagged as transparency but has many values\n"
                 "between 0 and 255, as near infrared, is not used as such)")
      ->delimiter(',')
      ->option_text("R,G,B[,A]");
  app.add_option("--footprints", options.footprints,
                 "GeoJSON of building outlines, which become walls unchanged")
      ->option_text("FILE");
  app.add_option("--map", options.map,
                 "Map file to write the layer walls into; its other content is kept")
      ->required()
      ->option_text("FILE");
  app.add_flag("--allow-empty", options.allow_empty,
               "Write the map even if nothing was found for it");
  app.add_option("--debug-images", options.debug_images,
                 "Folder for a picture of each stage of each block")
      ->option_text("DIR");
  add_number(app, "--jobs", options.jobs, "N",
             "Threads that process blocks; the walls are the same for any number", 1, 256);

  ExtractionSettings& settings = options.settings;
  app.add_option("--sun-azimuth-deg", settings.sun_azimuth_deg,
                 "Azimuth of the sun, clockwise from north (0 to 360; without it: estimated "
                 "from the shadows)")
      ->check(CLI::Range(0.0, 360.0))
      ->option_text("DEG")
      ->group(kWallSettings);
  app.add_option("--sun-elevation-deg", settings.sun_elevation_deg,
                 "Elevation of the sun above the horizon (1 to 90; without it: 45)")
      ->check(CLI::Range(1.0, 90.0))
      ->option_text("DEG")
      ->group(kWallSettings);
  app.add_option("--without", options.without,
                 "Leave a stage out: shadows, vegetation, progressive, roofs, merging, closure or "
                 "corners; may "
                 "be repeated")
      ->check(CLI::IsMember(kStages))
      ->option_text("STAGE")
      ->group(kWallSettings);
  add_number(app, "--metres-per-pixel", settings.metres_per_pixel, "M",
             "Size on the ground of the pixels to work with", 0.02, 1)
      ->group(kWallSettings);
  add_number(app, "--min-length-m", settings.hough.shortest_m, "M", "Minimum length of a line", 0.5,
             20)
      ->group(kWallSettings);
  add_number(app, "--min-roof-difference", settings.roof_edges.min_difference, "X",
             "Minimum difference of the roof probability between both sides of a wall", 0, 1)
      ->group(kWallSettings);
}

Wall wall_of(const WallLine& line, const GroundFrame& frame) {
  const GeoPoint begin = frame.geo_from_ground(line.begin_m);
  const GeoPoint end = frame.geo_from_ground(line.end_m);
  return {{begin.latitude_deg, begin.longitude_deg},
          {end.latitude_deg, end.longitude_deg},
          kImageSigmaM};
}

WallLine line_of(const Wall& wall, const GroundFrame& frame) {
  return {frame.ground_from_geo({wall.begin.latitude_deg, wall.begin.longitude_deg, 0}),
          frame.ground_from_geo({wall.end.latitude_deg, wall.end.longitude_deg, 0})};
}

// The walls of footprints, and those of the image that no footprint covers.
std::vector<Wall> all_walls(std::vector<Wall> footprints,
                            const std::optional<ExtractedWalls>& extracted) {
  if (!extracted) return footprints;
  WallLines known;
  for (const Wall& wall : footprints) known.push_back(line_of(wall, extracted->frame));
  for (const WallLine& line : not_covered(extracted->lines, known, {})) {
    footprints.push_back(wall_of(line, extracted->frame));
  }
  return footprints;
}

WallLayerParameters parameters_of(const AerialOptions& options,
                                  const std::optional<ExtractedWalls>& extracted) {
  WallLayerParameters parameters;
  parameters.footprints = fs::path(options.footprints).filename().string();
  if (extracted) {
    parameters.extracted = {.image = options.image.file.filename().string(),
                            .bands = extracted->bands.shown,
                            .alpha_band = extracted->bands.alpha,
                            .bounds = extracted->bounds,
                            .metres_per_pixel = options.settings.metres_per_pixel,
                            .min_length_m = options.settings.hough.shortest_m,
                            .min_roof_difference = options.settings.roof_edges.min_difference,
                            .without = options.without,
                            .sun_azimuth_deg = extracted->sun.azimuth_deg,
                            .sun_elevation_deg = extracted->sun.elevation_deg,
                            .sun_was_estimated = extracted->sun_was_estimated};
  }
  return parameters;
}

// A note on a band that is not used as tagged; empty if there is none.
std::string note_on_bands(const ImageBands& bands) {
  if (bands.distrusted_alpha == 0) return "";
  return "band " + std::to_string(bands.distrusted_alpha) +
         " is treated as data, not as transparency";
}

std::string summary_line(const AerialOptions& options, const WallLayerReport& report,
                         const std::optional<ExtractedWalls>& extracted) {
  std::string line = options.map + ": build " + report.build + ", " + std::to_string(report.walls) +
                     " walls of " + fixed(report.length_m, 0) + " m in " +
                     std::to_string(report.cells) + (report.cells == 1 ? " cell" : " cells");
  if (extracted) {
    line += ", sun at azimuth " + fixed(extracted->sun.azimuth_deg, 0) + " degrees" +
            (extracted->sun_was_estimated ? " (estimated from the shadows)" : "");
    const std::string note = note_on_bands(extracted->bands);
    if (!note.empty()) line += "; " + note + " (--bands chooses)";
  }
  return line;
}

constexpr const char* kAllowEmpty = "or write the map without walls with --allow-empty";

Error no_wall_in_footprints(const AerialOptions& options, const std::string& contents) {
  return {ErrorCode::invalid_input, options.footprints, "it holds " + contents + ", so no wall",
          std::string("give the outlines of buildings as Polygons, ") + kAllowEmpty};
}

Error no_wall_in_image(const AerialOptions& options, const ExtractedWalls& extracted) {
  const std::string file = options.image.file.string();
  if (!extracted.shows_anything) {
    return {ErrorCode::invalid_input, file, "the whole image is transparent or without data",
            std::string("choose its bands with --bands, ") + kAllowEmpty};
  }
  const std::string note = note_on_bands(extracted.bands);
  return {ErrorCode::invalid_input, file,
          "no wall was found in it" + (note.empty() ? note : " (" + note + ")"),
          std::string("inspect its stages (--debug-images), ") + kAllowEmpty};
}

// The walls of the footprints, if a file is given. Errors: those of read_footprints; invalid_input
// if it has none.
Result<std::vector<Wall>> footprint_walls(const AerialOptions& options) {
  if (options.footprints.empty()) return std::vector<Wall>();
  Result<Footprints> footprints = read_footprints(options.footprints);
  if (!footprints) return footprints.error();
  for (Wall& wall : footprints->walls) wall.sigma_m = kFootprintSigmaM;
  Result<std::vector<Wall>> walls = storable_walls(footprints->walls);
  if (walls && walls->empty() && !options.allow_empty) {
    return no_wall_in_footprints(options, footprints->contents);
  }
  return walls;
}

Result<std::optional<ExtractedWalls>> extracted_walls(const AerialOptions& options) {
  if (options.image.file.empty()) return std::optional<ExtractedWalls>();
  ProgressLine progress;
  Result<ExtractedWalls> extracted =
      extract_walls(options.image, options.settings, options.jobs, options.debug_images,
                    [&](const ExtractionProgress& at) {
                      progress.show("block " + std::to_string(at.blocks_done) + " of " +
                                    std::to_string(at.blocks_total));
                      return !stop_requested();
                    });
  if (!extracted) return extracted.error();
  return std::optional(std::move(*extracted));
}

Status make_folder(const std::string& folder) {
  if (folder.empty()) return ok_status();
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) return ok_status();
  return Error{ErrorCode::io, folder, "the folder cannot be created (" + error.message() + ")",
               "give another folder with --debug-images"};
}

// Throws: CLI::ParseError, where the options contradict each other.
void check_options(const AerialOptions& options) {
  if (options.image.file.empty() && options.footprints.empty()) {
    throw CLI::RequiredError("--image or --footprints");
  }
  if (options.image.bands.empty()) return;
  const Result<ImageBands> bands = bands_named(options.image.bands);
  if (!bands) {
    throw CLI::ValidationError("--bands", bands.error().what + "; " + bands.error().hint);
  }
}

int extract(const std::string& program, const AerialOptions& options) {
  catch_stop_signals();
  cv::setNumThreads(1);  // one block per thread uses the cores better than many threads per block
  Result<std::vector<Wall>> footprints = footprint_walls(options);
  if (!footprints) return fail(program, footprints.error());
  if (const Status made = make_folder(options.debug_images); !made) {
    return fail(program, made.error());
  }
  const Result<std::optional<ExtractedWalls>> extracted = extracted_walls(options);
  if (!extracted) return fail(program, extracted.error());
  const Result<std::vector<Wall>> walls =
      storable_walls(all_walls(std::move(*footprints), *extracted));
  if (!walls) return fail(program, walls.error());
  if (walls->empty() && *extracted && !options.allow_empty) {
    return fail(program, no_wall_in_image(options, **extracted));
  }
  const Result<WallLayerReport> report =
      write_wall_layer(options.map, *walls, parameters_of(options, *extracted));
  if (!report) return fail(program, report.error());
  std::cout << summary_line(options, *report, *extracted) << "\n";
  return kExitDone;
}

}  // namespace

RunCommand add_aerial(CLI::App& app) {
  app.description(kAerialDescription);
  const auto options = std::make_shared<AerialOptions>();
  add_aerial_options(app, *options);
  app.callback([options] {
    check_options(*options);
    for (const std::string& stage : options->without) {
      options->settings.without.insert(kStages.at(stage));
    }
  });
  return [options, program = name_of(app)] { return extract(program, *options); };
}

}  // namespace milepost
