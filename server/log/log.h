// Where the lines of the server's log go.
#pragma once

#include <memory>

#include "server/log/log_writer.h"

namespace milepost::server {

// From now on spdlog's default logger writes through `writer`.
void log_to(std::shared_ptr<LogWriter> writer);

}  // namespace milepost::server
