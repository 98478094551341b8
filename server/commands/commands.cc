#include "server/commands/commands.h"

namespace milepost::server {

std::vector<Command> subcommands() {
  return {{"keygen", add_keygen},   {"sign", add_sign},         {"publish", add_publish},
          {"install", add_install}, {"rollback", add_rollback}, {"token", add_token_command}};
}

}  // namespace milepost::server
