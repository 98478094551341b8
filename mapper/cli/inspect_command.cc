#include <iostream>

#include <nlohmann/json.hpp>

#include "mapper/cli/commands.h"
#include "mapper/cli/finding_output.h"
#include "mapper/inspect/inspection.h"
#include "mapper/inspect/verification.h"
#include "schema/command/command.h"

namespace milepost {
namespace {

struct MapFileOptions {
  std::string map;
  bool json = false;
};

void add_map_options(CLI::App& app, MapFileOptions& options) {
  app.add_option("--map", options.map, "Map file to read")->required()->option_text("FILE");
  app.add_flag("--json", options.json, "As JSON");
}

int inspect_map(const std::string& program, const MapFileOptions& options) {
  const Result<MapReader> map = MapReader::open(options.map);
  if (!map) return fail(program, map.error());
  const Result<MapInspection> inspected = inspect(*map);
  if (!inspected) return fail(program, inspected.error());
  std::cout << (options.json ? to_json(*inspected).dump(2) + "\n" : text_of(*inspected));
  return kExitDone;
}

int verify_map_file(const std::string& program, const MapFileOptions& options) {
  const Result<MapReader> map = MapReader::open(options.map);
  if (!map) return fail(program, map.error());
  const std::vector<Finding> found = contradictions_in(*map);
  if (options.json) {
    std::cout << nlohmann::ordered_json{{"build", map->build()}, {"contradictions", json_of(found)}}
                     .dump(2)
              << "\n";
  } else {
    for (const Finding& finding : found)
      fail(program, {ErrorCode::corrupt, finding.place(), finding.what, finding.hint});
    if (found.empty())
      std::cout << options.map << ": build " << map->build() << ", every byte is as it was built\n";
  }
  return found.empty() ? kExitDone : kExitFailed;
}

}  // namespace

RunCommand add_inspect(CLI::App& app) {
  app.description(
      R"(Tells what a map holds: its layers, and for each segment its length, passes, landmarks per
metre, how well its positions are known, where it has few landmarks, and where it goes on.
Example: milepost-mapper inspect --map maps/town.map)");
  const auto options = std::make_shared<MapFileOptions>();
  add_map_options(app, *options);
  return [options, program = name_of(app)] { return inspect_map(program, *options); };
}

RunCommand add_verify(CLI::App& app) {
  app.description(
      R"(Checks every byte of a map: digests against the build, tiles, links between segments, lines.
Each contradiction is a line; the exit code is 1 if there is one.
Example: milepost-mapper verify --map maps/town.map)");
  const auto options = std::make_shared<MapFileOptions>();
  add_map_options(app, *options);
  return [options, program = name_of(app)] { return verify_map_file(program, *options); };
}

}  // namespace milepost
