// The subcommands of milepost-server; without one it serves maps.
#pragma once

#include <vector>

#include "schema/command/command.h"

namespace milepost::server {

RunCommand add_keygen(CLI::App& app);
RunCommand add_sign(CLI::App& app);
RunCommand add_publish(CLI::App& app);
RunCommand add_install(CLI::App& app);
RunCommand add_rollback(CLI::App& app);
RunCommand add_token_command(CLI::App& app);

// All of them.
std::vector<Command> subcommands();

}  // namespace milepost::server
