#include <iostream>
#include <memory>
#include <string>

#include "schema/base/digest.h"
#include "schema/base/ids.h"
#include "server/catalog/build_store.h"
#include "server/commands/commands.h"

namespace milepost::server {
namespace {

constexpr const char* kRollbackDescription =
    R"(Makes an older build of a map the current one again, also while it is served.

The build was kept by `install`. Every byte of it is checked before it takes the place of the map's
file, by renaming; the build that it replaces is kept in turn, so that a second rollback takes the
first one back. Vehicles follow as they follow any new build. With keys, sign the map again: a vehicle
refuses a build that was signed before one that it has accepted.
Examples: milepost-server rollback --maps /srv/milepost --map town
          milepost-server rollback --maps /srv/milepost --map town --list)";

struct RollbackOptions {
  std::string maps;
  std::string map;
  std::string build;
  bool only_list = false;
};

int roll_back(const std::string& program, const RollbackOptions& options) {
  BuildStore store(options.maps);
  if (options.only_list) {
    for (const KeptBuild& kept : store.kept(options.map)) std::cout << kept.build << '\n';
    return kExitDone;
  }
  const Result<std::string> build = store.roll_back(options.map, options.build);
  if (!build) return fail(program, build.error());
  std::cout << options.map << ": build " << *build << " is the current one again\n";
  return kExitDone;
}

}  // namespace

RunCommand add_rollback(CLI::App& app) {
  app.description(kRollbackDescription);
  const auto options = std::make_shared<RollbackOptions>();
  app.add_option("--maps", options->maps, "Directory of the maps")
      ->required()
      ->check(CLI::ExistingDirectory)
      ->option_text("DIR");
  app.add_option("--map", options->map, "Name of the map")->required()->option_text("NAME");
  CLI::Option* to = app.add_option("--to", options->build,
                                   "The build (default: the latest that was current before)")
                        ->option_text("BUILD");
  app.add_flag("--list", options->only_list, "List the builds that are kept, the latest first")
      ->excludes(to);
  app.callback([options] {
    if (!is_segment_id(options->map)) {
      throw CLI::ValidationError("--map " + options->map, "not the name of a map");
    }
    if (!options->build.empty() && !is_digest(options->build)) {
      throw CLI::ValidationError("--to " + options->build,
                                 "not a build: 32 lower-case hexadecimal digits");
    }
  });
  return [options, program = name_of(app)] { return roll_back(program, *options); };
}

}  // namespace milepost::server
