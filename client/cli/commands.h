// The subcommands of milepost-client.
#pragma once

#include "schema/command/command.h"

namespace milepost {

RunCommand add_find(CLI::App& app);
RunCommand add_localize(CLI::App& app);
RunCommand add_evaluate(CLI::App& app);
RunCommand add_vanishing(CLI::App& app);

}  // namespace milepost
