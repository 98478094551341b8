#include <ostream>

#include "mapper/cli/commands.h"
#include "mapper/export/geojson.h"
#include "schema/base/file.h"
#include "schema/base/output_file.h"
#include "schema/command/command.h"

namespace milepost {
namespace {

struct ExportOptions {
  std::string map;
  std::string layer;
  std::string geojson;
};

constexpr const char* kExportDescription =
    R"(Writes walls or the road network of a map as GeoJSON (RFC 7946), in WGS84.

A layer of walls becomes one LineString per wall, with sigma_m; the interior of a building, if it
is known, is on the right of its walls. 'segments' becomes one LineString per segment, with id,
length_m and successors; its positions have the altitude above the ellipsoid. What crosses
longitude 180 is split there, into a MultiLineString.
Example: milepost-mapper export --map maps/town.map --layer walls --geojson walls.geojson)";

int export_layer(const std::string& program, const ExportOptions& options) {
  const Result<MapReader> map = MapReader::open(options.map);
  if (!map.ok()) return fail(program, map.error());
  if (const Status free =
          check_outputs({{"--geojson", options.geojson, &kGeoJsonOutput}}, {options.map});
      !free) {
    return fail(program, free.error());
  }
  const bool segments = options.layer == kSegments;
  const Result<GeoJson> json =
      segments ? segments_geojson(*map) : walls_geojson(*map, options.layer);
  if (!json.ok()) return fail(program, json.error());
  const Status written = write_text_file(options.geojson, json->text);
  if (!written.ok()) return fail(program, written.error());
  report_stream(options.geojson) << options.geojson << ": " << json->features
                                 << (segments ? " segments" : " walls") << "\n";
  return kExitDone;
}

}  // namespace

RunCommand add_export(CLI::App& app) {
  app.description(kExportDescription);
  const auto options = std::make_shared<ExportOptions>();
  app.add_option("--map", options->map, "Map file to read")->required()->option_text("FILE");
  app.add_option("--layer", options->layer, "A layer of walls, or 'segments' for the road network")
      ->required()
      ->option_text("NAME");
  app.add_option("--geojson", options->geojson,
                 "File to write; an existing GeoJSON file is replaced on success")
      ->required()
      ->option_text("FILE");
  return [options, program = name_of(app)] { return export_layer(program, *options); };
}

}  // namespace milepost
