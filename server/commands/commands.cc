#include "server/commands/commands.h"

namespace milepost::server {

std::vector<Command> subcommands() { return {{"keygen", add_keygen}, {"sign", add_sign}}; }

}  // namespace milepost::server
