// What milepost-server does without a subcommand.
#pragma once

#include "schema/base/result.h"
#include "server/log/log_writer.h"
#include "server/options.h"

namespace milepost::server {

// Prints a line for each map of the directory, and for each that would be left out. Errors: those
// of Catalog::open; corrupt if a map would be left out.
Status check(const Options& options);

// Serves the maps until SIGINT or SIGTERM; `log` writes the lines of spdlog. REQUIRES: no other
// thread was started yet, but for the log's. Errors: those of Catalog::open, Server::start and
// Viewer::with.
Status serve(const Options& options, const LogWriter& log);

}  // namespace milepost::server
