#include "client/fetch/transport.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include "tests/support/scripted_server.h"

namespace milepost::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::uint64_t kPlenty = 1U << 20U;

class TransportTest : public ::testing::Test {
 protected:
  HttpAnswer get(const std::string& path, std::uint64_t limit_bytes = kPlenty) {
    body_.clear();
    return transport_->get(server_.url() + path, limit_bytes, [this](ByteView piece) {
      body_ += as_text(piece);
      return ok_status();
    });
  }

  static Error error_of(const HttpAnswer& answer) {
    if (answer.status.ok()) ADD_FAILURE() << "it went well";
    return answer.status.ok() ? Error{} : answer.status.error();
  }

  ScriptedAnswer answer_;
  std::string body_;
  ScriptedServer server_{[this](const std::string& target) -> ScriptedAnswer {
    if (target == "/target") return {.body = "the target"};
    if (target == "/loop") return {.status = 302, .headers = {{"Location", "/loop"}}};
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
  EXPECT_EQ(error_of(get("/loop")).code, ErrorCode::invalid_input);
  EXPECT_EQ(server_.requests().size(), 6U);
}

TEST_F(TransportTest, FollowsNoRedirectToAFile) {
  answer_ = {.status = 301, .headers = {{"Location", "file:///etc/hostname"}}};
  const Error error = error_of(get("/"));
  EXPECT_EQ(error.code, ErrorCode::invalid_input);
  EXPECT_THAT(error.what, HasSubstr("Protocol"));  // refused, not tried in vain
}

TEST_F(TransportTest, AsksNoFile) {
  const HttpAnswer answer =
      transport_->get("file:///etc/hostname", kPlenty, [](ByteView) { return ok_status(); });
  EXPECT_EQ(error_of(answer).code, ErrorCode::invalid_input);
  EXPECT_THAT(error_of(answer).what, HasSubstr("Protocol"));
}

TEST_F(TransportTest, MapsTheStatus) {
  const std::vector<std::pair<int, ErrorCode>> cases = {
      {400, ErrorCode::invalid_input}, {403, ErrorCode::invalid_input},
      {404, ErrorCode::not_found},     {410, ErrorCode::gone},
      {429, ErrorCode::unavailable},   {500, ErrorCode::unavailable},
      {502, ErrorCode::unavailable},   {503, ErrorCode::unavailable},
      {204, ErrorCode::invalid_input},
  };
  for (const auto& [status, code] : cases) {
    answer_ = {.status = status};
    const Error error = error_of(get("/here"));
    EXPECT_EQ(error.code, code) << status;
    EXPECT_THAT(error.line(), StartsWith(server_.url() + "/here: ")) << status;
    EXPECT_EQ(body_, "") << status;
  }
}

TEST_F(TransportTest, TellsTheServersDetailInOneLine) {
  answer_ = {.status = 400, .body = R"({"title": "no", "detail": "from_m is\nno number"})"};
  EXPECT_THAT(error_of(get("/")).line(), HasSubstr("from_m is no number"));
}

TEST_F(TransportTest, TheDetailMayBeMissingOrAbsurd) {
  for (const std::string body :
       {"", "<html>", "[1]", R"({"detail": 7})", "{\"detail\": \"\xff\"}"}) {
    answer_ = {.status = 404, .body = body};
    EXPECT_EQ(error_of(get("/", 3)).code, ErrorCode::not_found) << body;
  }
}

TEST_F(TransportTest, AnEndlessProblemIsCutOff) {
  answer_ = {.status = 404, .body = std::string(1 << 20, 'x')};
  const HttpAnswer answer = get("/");
  EXPECT_EQ(error_of(answer).code, ErrorCode::not_found);
  EXPECT_LT(answer.body_bytes, 1U << 18U);
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
  const HttpAnswer answer = transport_->get(server_.url(), kPlenty, [](ByteView) -> Status {
    return Error{ErrorCode::corrupt, "here", "enough", ""};
  });
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
  const HttpAnswer answer =
      transport_->get("http://milepost.invalid/x", kPlenty, [](ByteView) { return ok_status(); });
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
