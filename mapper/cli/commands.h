// The subcommands of milepost-mapper.
#pragma once

#include "schema/command/command.h"

namespace milepost {

RunCommand add_build(CLI::App& app);
RunCommand add_codebook(CLI::App& app);
RunCommand add_aerial(CLI::App& app);
RunCommand add_export(CLI::App& app);
RunCommand add_import(CLI::App& app);
RunCommand add_inspect(CLI::App& app);
RunCommand add_report(CLI::App& app);
RunCommand add_verify(CLI::App& app);

}  // namespace milepost
