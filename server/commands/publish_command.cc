#include <iostream>
#include <memory>
#include <string>

#include "server/commands/commands.h"
#include "server/commands/whole_catalog.h"
#include "server/publish/publication.h"

namespace milepost::server {
namespace {

constexpr const char* kPublishDescription =
    R"(Writes maps as plain files that an object store or a static web server serves as this one.

The folder gets the tree under /v1/: each map's documents and tiles, and headers.json, which lists
the header fields that each file is to be served with. Clients recognize such a store by itself:
milepost-client --server URL is the URL of the folder that holds v1/. Documents are stored as
index.json in the folder of their URL, which clients ask for; a store needs no rewriting of URLs.
Published again, only what differs is written. Old builds stay, for vehicles that drive by them,
until --remove-old. The tree is valid at any time, also if the command is killed.
Examples: milepost-server publish --maps /srv/milepost --out tree
          rclone copy tree/v1 store:bucket/v1 --header-upload 'Cache-Control: no-cache'
              to an object store; PROTOCOL.md, section 6, has the commands with each group's
              headers, and the configuration of nginx)";

struct PublishOptions {
  std::string maps;
  std::string out;
  bool remove_old = false;
};

int run_publish(const std::string& program, const PublishOptions& options) {
  const auto catalog = open_whole_catalog(options.maps);
  if (!catalog) return fail(program, catalog.error());
  catch_stop_signals();
  const Result<PublishCounts> counts = [&] {
    ProgressLine progress;
    return publish(**catalog,
                   {options.out, options.remove_old,
                    [&](const std::string& text) { progress.show(text); }, stop_requested});
  }();
  if (!counts) return fail(program, counts.error());
  std::cout << options.out << ": " << (*catalog)->maps().size() << " maps, " << counts->files
            << " files, " << counts->written << " written, " << counts->removed
            << " old builds removed\n";
  return kExitDone;
}

}  // namespace

RunCommand add_publish(CLI::App& app) {
  app.description(kPublishDescription);
  const auto options = std::make_shared<PublishOptions>();
  app.add_option("--maps", options->maps, "Directory of the map files")
      ->required()
      ->option_text("DIR");
  app.add_option("--out", options->out, "Folder to write to: a new, an empty or a published one")
      ->required()
      ->option_text("DIR");
  app.add_flag("--remove-old", options->remove_old,
               "Remove builds and maps that are no longer among the maps");
  return [options, program = name_of(app)] { return run_publish(program, *options); };
}

}  // namespace milepost::server
