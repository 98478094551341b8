// The line of the log for a request.
#include "server/http/exchange.h"

#include <gmock/gmock.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <sstream>

#include "server/log/printable.h"
#include "server/metrics/metrics.h"

namespace milepost::server {
namespace {

TEST(PrintableTest, NothingOfAClientLooksLikeTheLogOrControlsATerminal) {
  EXPECT_EQ(printable("/v1/maps?near=49,8"), "/v1/maps?near=49,8");
  EXPECT_EQ(printable("a\r\n\x1b[31m\x7f\xc3\xa4"), "a\\x0d\\x0a\\x1b[31m\\x7f\\xc3\\xa4");
  EXPECT_EQ(printable("/\" 200 \\x"), "/\\\" 200 \\\\x");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\x00");
}

class ExchangeTest : public ::testing::Test {
 protected:
  ExchangeTest() : before_(spdlog::default_logger()) {
    const auto sink = std::make_shared<spdlog::sinks::ostream_sink_mt>(text_);
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", sink));
    spdlog::set_pattern("%v");
  }
  ~ExchangeTest() override { spdlog::set_default_logger(before_); }

  Metrics metrics_{{}};
  std::ostringstream text_;
  std::shared_ptr<spdlog::logger> before_;
};

TEST_F(ExchangeTest, IsOneLine) {
  observe({"127.0.0.1", "GET", "/a\nb", 200, 12, std::chrono::microseconds(1500), false}, metrics_);
  EXPECT_EQ(text_.str(), "127.0.0.1 \"GET /a\\x0ab\" 200 12 bytes 1.5 ms\n");
  text_.str("");
  observe({"unix", "GET", "/", 200, 12, std::chrono::microseconds(500), true, {}, {}, 0, "fleet"},
          metrics_);
  EXPECT_EQ(text_.str(), "unix fleet \"GET /\" 200 12 bytes 0.5 ms, aborted\n");
}

TEST_F(ExchangeTest, IsLoggedAtLevelInfoOnly) {
  spdlog::default_logger()->set_level(spdlog::level::warn);
  observe({"127.0.0.1", "GET", "/", 200, 12, std::chrono::microseconds(1500), false}, metrics_);
  EXPECT_EQ(text_.str(), "");
}

}  // namespace
}  // namespace milepost::server
