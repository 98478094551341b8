#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "server/catalog/build_store.h"
#include "server/commands/commands.h"

namespace milepost::server {
namespace {

constexpr const char* kInstallDescription =
    R"(Takes up new builds of maps in a directory, also while it is served.

Each file is copied, every byte of the copy is checked, and it takes the place of the map's file by
renaming: a server that watches the directory serves it within a second. With town.map goes its
signature town.map.sig, if there is one. The build before it is kept in DIR/.builds: `rollback` makes
it the current one again, and vehicles that have it fetch only what differs.
Example: milepost-server install --maps /srv/milepost town.map)";

constexpr std::size_t kMostKept = 1000;

struct InstallOptions {
  std::string maps;
  std::vector<std::string> files;
  std::size_t keep = 3;
};

int install(const std::string& program, const InstallOptions& options) {
  BuildStore store(options.maps);
  for (const std::string& file : options.files) {
    const Result<std::string> build = store.install(file, options.keep);
    if (!build) return fail(program, build.error());
    std::cout << file << ": build " << *build << " is installed\n";
  }
  return kExitDone;
}

}  // namespace

RunCommand add_install(CLI::App& app) {
  app.description(kInstallDescription);
  const auto options = std::make_shared<InstallOptions>();
  app.add_option("--maps", options->maps, "Directory of the maps")
      ->required()
      ->check(CLI::ExistingDirectory)
      ->option_text("DIR");
  app.add_option("FILE", options->files, "Map files; each one's name is the map's")
      ->required()
      ->option_text(" ");
  add_number(app, "--keep", options->keep, "N", "Older builds of each map to keep", 0, kMostKept);
  return [options, program = name_of(app)] { return install(program, *options); };
}

}  // namespace milepost::server
