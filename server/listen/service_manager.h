// What a service manager hands over and is told, as systemd defines it (sd_listen_fds(3),
// sd_notify(3)).
#pragma once

#include <string>
#include <vector>

#include "schema/base/result.h"

namespace milepost::server {

// The descriptors of the listening sockets that this process inherited. Removes the variables that
// name them from the environment, so that no child takes them for its own. Call it once, before
// other threads start.
std::vector<int> inherited_descriptors();

// Reports a state such as "READY=1" or "STOPPING=1". Does nothing without a service manager that
// wants to know. Errors: io.
Status notify_service_manager(const std::string& state);

}  // namespace milepost::server
