// Output of the server's log.
#pragma once

#include <memory>
#include <string>

#include "server/log/log_writer.h"

namespace milepost::server {

struct LogSettings {
  std::string level = "info";   // the least that is logged: debug, info, warn, error, off
  std::string format = "text";  // or json: an object with time, level and message a line
};

// Makes spdlog's default logger write through `writer`.
void log_to(std::shared_ptr<LogWriter> writer, const LogSettings& settings = {});

}  // namespace milepost::server
