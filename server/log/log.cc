#include "server/log/log.h"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <mutex>
#include <string_view>
#include <utility>

namespace milepost::server {
namespace {

class WriterSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit WriterSink(std::shared_ptr<LogWriter> writer) : writer_(std::move(writer)) {}

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    writer_->write({line.data(), line.size()});
  }
  void flush_() override {}  // the writer writes without delay

  std::shared_ptr<LogWriter> writer_;
};

}  // namespace

void log_to(std::shared_ptr<LogWriter> writer) {
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("server", std::make_shared<WriterSink>(std::move(writer))));
}

}  // namespace milepost::server
