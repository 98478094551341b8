// The map source of a command: --server URL --cache DIR, or --map FILE.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/fetch/map_source.h"
#include "schema/command/command.h"
#include "schema/drive/drive.h"

namespace milepost {

struct SourceOptions {
  std::string server;
  std::string cache;
  std::string map;
  std::vector<std::string> keys;  // files
  std::string token_file;
  std::string ca_file;
  double cache_limit_mb = 1024;

  std::string name() const { return map.empty() ? server : map; }
};

void add_source_options(CLI::App& app, SourceOptions& options);

// Throws: CLI::RequiredError if neither a server nor a map file was given.
void require_source(const SourceOptions& options);

// --receiver-until-s, of commands that replay a drive.
void add_receiver_option(CLI::App& app, std::optional<double>& until_s);

// The files read by a command that replays a drive on a map.
std::vector<std::filesystem::path> inputs_of(const Drive& drive, const SourceOptions& options);

// Errors: those of open_http_source and open_file_source.
Result<std::shared_ptr<MapSource>> open_source(const SourceOptions& options);

}  // namespace milepost
