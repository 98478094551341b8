// Output of the server's log.
#pragma once

#include <memory>

#include "server/log/log_writer.h"

namespace milepost::server {

// Makes spdlog's default logger write through `writer`.
void log_to(std::shared_ptr<LogWriter> writer);

}  // namespace milepost::server
