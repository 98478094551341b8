// milepost-server: serves a directory of maps until it is stopped by a signal; or, by a subcommand,
// works on such a directory.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <memory>
#include <variant>

#include "server/commands/commands.h"
#include "server/listen/service_manager.h"
#include "server/log/log.h"
#include "server/options.h"
#include "server/serve.h"

namespace {

using namespace milepost;

// Timeout for the last lines of the log when the server stops.
constexpr std::chrono::milliseconds kLastLines{500};

// Opens /dev/null for closed standard descriptors, so that no file or socket gets their numbers.
void open_standard_descriptors() {
  while (true) {
    const int descriptor = ::open("/dev/null", O_RDWR);
    if (descriptor <= STDERR_FILENO && descriptor >= 0) continue;
    if (descriptor >= 0) ::close(descriptor);
    return;
  }
}

// A log whose reader ends, or whose file reaches its size limit, does not end the server.
void ignore_failures_of_the_log() {
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
}

// Whether the first argument names a subcommand.
bool calls_subcommand(int argc, char** argv) {
  return argc > 1 && std::ranges::any_of(server::subcommands(), [&](const Command& command) {
           return command.name == argv[1];
         });
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_descriptors();
  if (calls_subcommand(argc, argv)) {
    return run_program("milepost-server",
                       "Installs, rolls back, publishes and signs maps, and makes tokens.",
                       server::subcommands(), argc, argv);
  }
  const auto parsed = server::parse_options(argc, argv, server::inherited_descriptors());
  if (const int* exit_code = std::get_if<int>(&parsed)) return *exit_code;
  const auto& options = std::get<server::Options>(parsed);
  ignore_failures_of_the_log();
  const auto log = std::make_shared<server::LogWriter>(STDERR_FILENO);
  server::log_to(log, options.log);
  const Status done = options.only_check ? server::check(options) : server::serve(options, *log);
  if (!done) log->write("milepost-server: " + done.error().line() + '\n');
  log->close(kLastLines);
  return done ? 0 : 1;
}
