#include "client/fetch/transport.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <chrono>

#include "tests/support/scripted_server.h"

namespace milepost::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr std::uint64_t kPlenty = 1U << 20U;

class TransportTest : public ::testing::Test {
 protected:
  HttpAnswer get(const std::string& path, std::uint64_t limit_bytes = kPlenty) {
    body_.clear();
    return transport_->get(
        server_.url() + path, limit_bytes, caches_,
        [this](ByteView piece) {
          body_ += as_text(piece);
          return ok_status();
        },
        stopped_);
  }

  static Error error_of(const HttpAnswer& answer) {
    if (answer.status.ok()) ADD_FAILURE() << "it went well";
    return answer.status.ok() ? Error{} : answer.status.error();
  }

  // Expects that the response is attributed to something other than a milepost server, and reported
  // so.
  static void expect_foreign(const HttpAnswer& answer, const std::string& detail) {
    const Error error = error_of(answer);
    EXPECT_EQ(error.code, ErrorCode::unavailable);
    EXPECT_THAT(error.line(), HasSubstr("something other than a milepost server answered"));
    EXPECT_THAT(error.line(), HasSubstr(detail));
    EXPECT_THAT(error.line(), HasSubstr("log in to the network"));
  }

  const std::map<std::string, std::string> kProblem = {
      {"Content-Type", "application/problem+json"}};
  ScriptedAnswer answer_;
  std::string body_;
  Caches caches_ = Caches::allowed;
  Stopped stopped_;
  ScriptedServer server_{[this](const std::string& target) -> ScriptedAnswer {
    if (target == "/target") return {.body = "the target"};
    if (target == "/loop") return {.status = 302, .headers = {{"Location", "/loop"}}};
    if (target == "/login") return {.body = "<html>", .headers = {{"Content-Type", "text/html"}}};
    return answer_;
  }};
  std::unique_ptr<Transport> transport_ = make_curl_transport({1, 1});
};

TEST_F(TransportTest, BringsTheBody) {
  answer_.body = std::string(300000, 'x');
  const HttpAnswer answer = get("/");
  EXPECT_TRUE(answer.status.ok());
  EXPECT_EQ(body_, answer_.body);
  EXPECT_EQ(answer.body_bytes, 300000U);
  EXPECT_THAT(server_.user_agent(), StartsWith("milepost/"));
}

TEST_F(TransportTest, AsksPastCachesWhereItIsTold) {
  EXPECT_TRUE(get("/target").status.ok());
  EXPECT_EQ(server_.cache_control(), "");
  caches_ = Caches::bypassed;
  EXPECT_TRUE(get("/target").status.ok());
  EXPECT_EQ(server_.cache_control(), "no-cache");
  caches_ = Caches::allowed;
  EXPECT_TRUE(get("/target").status.ok());
  EXPECT_EQ(server_.cache_control(), "");
}

TEST_F(TransportTest, KeepsTheConnectionOpen) {
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(get("/target").status.ok());
  EXPECT_EQ(server_.connections(), 1U);
}

TEST_F(TransportTest, FollowsARedirect) {
  answer_ = {.status = 301, .headers = {{"Location", "/target"}}};
  EXPECT_TRUE(get("/").status.ok());
  EXPECT_EQ(body_, "the target");
}

TEST_F(TransportTest, FollowsNoLoopOfRedirects) {
  expect_foreign(get("/loop"), "redirects");
  EXPECT_EQ(server_.requests().size(), 6U);
}

TEST_F(TransportTest, FollowsNoRedirectToAFile) {
  answer_ = {.status = 301, .headers = {{"Location", "file:///etc/hostname"}}};
  expect_foreign(get("/"), "Protocol");  // rejected, not attempted
}

TEST_F(TransportTest, FollowsNoRedirectToNowhere) {
  for (const std::string location : {"http://[", "intent://login", "", "http://127.0.0.1:0/"}) {
    answer_ = {.status = 302, .headers = {{"Location", location}}};
    EXPECT_EQ(error_of(get("/")).code, ErrorCode::unavailable) << location;
  }
}

TEST_F(TransportTest, AsksNoFile) {
  const HttpAnswer answer = transport_->get("file:///etc/hostname", kPlenty, Caches::allowed,
                                            [](ByteView) { return ok_status(); }, {});
  EXPECT_EQ(error_of(answer).code, ErrorCode::invalid_input);
  EXPECT_THAT(error_of(answer).what, HasSubstr("Protocol"));
}

TEST_F(TransportTest, MapsTheStatusOfAProblem) {
  const std::vector<std::pair<int, ErrorCode>> cases = {
      {400, ErrorCode::invalid_input}, {404, ErrorCode::not_found},
      {405, ErrorCode::invalid_input}, {410, ErrorCode::gone},
      {401, ErrorCode::unavailable},   {403, ErrorCode::unavailable},
      {414, ErrorCode::invalid_input}, {429, ErrorCode::unavailable},
      {431, ErrorCode::invalid_input}, {500, ErrorCode::unavailable},
      {503, ErrorCode::unavailable},
  };
  for (const auto& [status, code] : cases) {
    for (const std::string type :
         {"application/problem+json", "Application/Problem+JSON; charset=utf-8"}) {
      answer_ = {.status = status, .body = "{}", .headers = {{"Content-Type", type}}};
      const Error error = error_of(get("/here"));
      EXPECT_EQ(error.code, code) << status;
      EXPECT_THAT(error.line(), StartsWith(server_.url() + "/here: ")) << status;
      EXPECT_EQ(body_, "") << status;
    }
  }
}

TEST_F(TransportTest, WhatIsNoProblemSaysNothingAboutTheMap) {
  for (const int status : {204, 206, 304, 400, 401, 403, 404, 405, 407, 410, 418, 451, 511}) {
    for (const std::string type : {"text/html", "application/json", ""}) {
      SCOPED_TRACE(std::to_string(status) + " " + type);
      answer_ = {.status = status, .body = R"({"detail": "log in"})"};
      if (!type.empty()) answer_.headers["Content-Type"] = type;
      if (status == 204 || status == 304) answer_.body.clear();
      expect_foreign(get("/here"), "HTTP status " + std::to_string(status));
      EXPECT_EQ(body_, "");
    }
  }
  for (const int status : {407, 418, 511}) {  // never a milepost server's
    answer_ = {.status = status, .body = "{}", .headers = kProblem};
    expect_foreign(get("/"), "HTTP status " + std::to_string(status));
  }
}

TEST_F(TransportTest, AnUnavailableServerNeedsNoProblem) {
  for (const int status : {429, 500, 502, 503, 504}) {
    answer_ = {.status = status, .body = "<html>", .headers = {{"Content-Type", "text/html"}}};
    EXPECT_EQ(error_of(get("/")).code, ErrorCode::unavailable) << status;
    EXPECT_THAT(error_of(get("/")).line(), HasSubstr("HTTP status " + std::to_string(status)));
  }
}

TEST_F(TransportTest, APageIsNoAnswer) {
  for (const std::string type : {"text/html", "TEXT/HTML;charset=x", "application/xhtml+xml"}) {
    for (const std::string body : {"<html>please log in</html>", "", "{}"}) {
      answer_ = {.body = body, .headers = {{"Content-Type", type}}};
      expect_foreign(get("/"), "HTTP status 200");
      EXPECT_EQ(body_, "");
    }
  }
  answer_ = {.body = std::string(1 << 20, 'x'), .headers = {{"Content-Type", "text/html"}}};
  expect_foreign(get("/", 1000), "text/html");
}

TEST_F(TransportTest, APageBehindARedirectIsNoAnswer) {
  answer_ = {.status = 302, .headers = {{"Location", "/login"}}};
  expect_foreign(get("/"), "text/html");
}

TEST_F(TransportTest, WhatIsNoHttpIsNoAnswer) {
  answer_ = {.headers = {{"Content-Length", "x"}}};
  EXPECT_EQ(error_of(get("/")).code, ErrorCode::unavailable);
}

TEST_F(TransportTest, ATypeIsToldWithoutItsControlCharacters) {
  answer_ = {.status = 403, .headers = {{"Content-Type", "a\x1b[31m\xff" + std::string(500, 'b')}}};
  const std::string line = error_of(get("/")).line();
  EXPECT_THAT(line, Not(HasSubstr("\x1b")));
  EXPECT_THAT(line, Not(HasSubstr("\xff")));
  EXPECT_LT(line.size(), 400U);
}

TEST_F(TransportTest, TellsTheServersDetailInOneLine) {
  answer_ = {.status = 400,
             .body = R"({"title": "no", "detail": "from_m is\nno number"})",
             .headers = kProblem};
  EXPECT_THAT(error_of(get("/")).line(), HasSubstr("from_m is no number"));
}

TEST_F(TransportTest, TheDetailMayBeMissing) {
  for (const std::string body : {"{}", R"({"detail": 7})", R"({"detail": [[[]]]})"}) {
    answer_ = {.status = 404, .body = body, .headers = kProblem};
    EXPECT_EQ(error_of(get("/", 3)).code, ErrorCode::not_found) << body;
  }
}

TEST_F(TransportTest, AProblemThatCannotBeReadIsNone) {
  const std::string deep = std::string(8000, '[') + std::string(8000, ']');
  for (const std::string& body :
       {std::string(), std::string("<html>"), std::string("[1]"),
        std::string("{\"detail\": \"\xff\"}"), "{\"detail\": " + deep + "}", deep,
        std::string(1 << 20, 'x'), std::string(2 << 20, '[')}) {
    answer_ = {.status = 404, .body = body, .headers = kProblem};
    const HttpAnswer answer = get("/");
    expect_foreign(answer, "HTTP status 404");
    EXPECT_LT(answer.body_bytes, 1U << 18U);
  }
}

TEST_F(TransportTest, ABodyBeyondTheLimitIsRefused) {
  answer_.body = std::string(1001, 'x');
  EXPECT_TRUE(get("/", 1001).status.ok());
  const Error error = error_of(get("/", 1000));
  EXPECT_EQ(error.code, ErrorCode::corrupt);
  EXPECT_THAT(error.line(), HasSubstr("1000 bytes"));
  EXPECT_THAT(error.line(), StartsWith(server_.url()));
}

TEST_F(TransportTest, TheSinkEndsTheRequest) {
  answer_.body = "abc";
  const HttpAnswer answer =
      transport_->get(server_.url(), kPlenty, Caches::allowed,
                      [](ByteView) -> Status {
                        return Error{ErrorCode::corrupt, "here", "enough", ""};
                      },
                      {});
  EXPECT_EQ(error_of(answer).line(), "here: enough");
}

TEST_F(TransportTest, ABodyThatBreaksOffIsUnavailable) {
  answer_ = {.body = std::string(1000, 'x'), .break_off_after = 400};
  const HttpAnswer answer = get("/");
  EXPECT_EQ(error_of(answer).code, ErrorCode::unavailable);
  EXPECT_EQ(answer.body_bytes, 400U);
}

TEST_F(TransportTest, ASilentServerIsUnavailable) {
  answer_.silent = true;
  EXPECT_EQ(error_of(get("/")).code, ErrorCode::unavailable);
}

TEST_F(TransportTest, AServerThatHangsIsLeftWhenItIsStopped) {
  answer_.silent = true;
  transport_ = make_curl_transport({600, 600});
  const auto began = std::chrono::steady_clock::now();
  stopped_ = [&] {
    return std::chrono::steady_clock::now() - began > std::chrono::milliseconds(50);
  };
  EXPECT_EQ(error_of(get("/")).code, ErrorCode::cancelled);
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(60));
}

TEST_F(TransportTest, ConnectionsAreUsedAgainAfterARequestThatWasStopped) {
  answer_.silent = true;
  int asked = 0;
  stopped_ = [&] { return ++asked > 3; };
  EXPECT_EQ(error_of(get("/")).code, ErrorCode::cancelled);
  stopped_ = {};
  EXPECT_TRUE(get("/target").status.ok());
  EXPECT_EQ(body_, "the target");
}

TEST_F(TransportTest, NoServerIsUnavailable) {
  server_.stop();
  const Error error = error_of(get("/some/where"));
  EXPECT_EQ(error.code, ErrorCode::unavailable);
  EXPECT_THAT(error.line(), StartsWith(server_.url() + "/some/where: "));
}

TEST_F(TransportTest, TellsTheRetryAfter) {
  answer_ = {.status = 503, .headers = {{"Retry-After", "7"}}};
  EXPECT_EQ(get("/").retry_after_s, 7);
  answer_ = {.status = 503};
  EXPECT_EQ(get("/").retry_after_s, 0);
}

TEST_F(TransportTest, TakesTheProxyFromTheEnvironment) {
  answer_.body = "through the proxy";
  setenv("http_proxy", server_.url().c_str(), 1);
  const HttpAnswer answer = transport_->get("http://milepost.invalid/x", kPlenty, Caches::allowed,
                                            [](ByteView) { return ok_status(); }, {});
  unsetenv("http_proxy");
  EXPECT_TRUE(answer.status.ok());
  EXPECT_THAT(server_.requests(), ::testing::ElementsAre("http://milepost.invalid/x"));
}

TEST(Urls, AreChecked) {
  EXPECT_EQ(*checked_server_url("http://host:8080"), "http://host:8080");
  EXPECT_EQ(*checked_server_url("https://host/maps//"), "https://host/maps");
  EXPECT_EQ(checked_server_url("host").error().code, ErrorCode::invalid_input);
}

TEST(Urls, AreEscaped) {
  EXPECT_EQ(escaped_for_url("a/b c?d"), "a%2Fb%20c%3Fd");
  EXPECT_EQ(escaped_for_url("plain-1.2_x"), "plain-1.2_x");
}

}  // namespace
}  // namespace milepost::testing
