#include "mapper/cli/export_command.h"

#include <ostream>

#include "mapper/export/geojson.h"
#include "schema/base/file.h"
#include "schema/base/output_file.h"
#include "schema/command/command.h"

namespace milepost {

int run_export(const std::string& program, std::vector<std::string> words) {
  CLI::App app(
      "Writes walls or the road network of a map as GeoJSON (RFC 7946), in WGS84.\n\n"
      "A layer of walls becomes a LineString a wall, with sigma_m; the interior of a building, "
      "where it\n"
      "is known, is on the right of its walls. 'segments' becomes a LineString a segment, with "
      "id,\n"
      "length_m and successors; its positions have the altitude above the ellipsoid. What crosses\n"
      "longitude 180 is cut there, into a MultiLineString.\n"
      "Example: milepost-mapper export --map maps/town.map --layer walls --geojson walls.geojson",
      program);
  std::string file;
  std::string layer;
  std::string out;
  app.add_option("--map", file, "Map file to read")->required()->option_text("FILE");
  app.add_option("--layer", layer, "A layer of walls, or 'segments' for the road network")
      ->required()
      ->option_text("NAME");
  app.add_option("--geojson", out,
                 "File to write; an old GeoJSON file is replaced when all is done")
      ->required()
      ->option_text("FILE");
  if (const auto code = parse_words(app, std::move(words))) return *code;

  const Result<MapReader> map = MapReader::open(file);
  if (!map.ok()) return fail(program, map.error());
  if (const Status free = check_outputs({{"--geojson", out, &kGeoJsonOutput}}, {file}); !free) {
    return fail(program, free.error());
  }
  const bool segments = layer == kSegments;
  const Result<GeoJson> json = segments ? segments_geojson(*map) : walls_geojson(*map, layer);
  if (!json.ok()) return fail(program, json.error());
  const Status written = write_text_file(out, json->text);
  if (!written.ok()) return fail(program, written.error());
  report_stream(out) << out << ": " << json->features << (segments ? " segments" : " walls")
                     << "\n";
  return kExitDone;
}

}  // namespace milepost
