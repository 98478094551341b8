#include "server/http/request_parser.h"

#include <gmock/gmock.h>

#include <string>

namespace milepost::server {
namespace {

using ::testing::HasSubstr;

constexpr const char* kRequest =
    "POST /v1/maps?x=%31 HTTP/1.1\r\nHost: test\r\nIf-None-Match: \"a\"\r\nif-none-match: \"b\"\r\n"
    "Transfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n0\r\nX: y\r\n\r\n";

unsigned status_of(const Incoming& incoming) {
  return incoming.refusal ? incoming.refusal->status : 0;
}

TEST(RequestParserTest, TakesOneRequestAndLeavesTheNext) {
  RequestParser parser({});
  const std::string request = kRequest;
  EXPECT_EQ(parser.take(request + "GET /"), request.size());
  ASSERT_TRUE(parser.done());
  const Incoming& incoming = parser.incoming();
  EXPECT_FALSE(incoming.refusal.has_value());
  EXPECT_EQ(incoming.request.method, "POST");
  EXPECT_EQ(incoming.request.target, "/v1/maps?x=%31");
  EXPECT_EQ(incoming.request.if_none_match, "\"a\", \"b\"");
  EXPECT_EQ(incoming.http_version, 11U);
  EXPECT_TRUE(incoming.keep_alive);
}

// The bytes in pieces of `size`, as received from a connection.
Incoming parsed_in_pieces(const std::string& bytes, std::size_t size) {
  RequestParser parser({});
  std::string waiting;
  for (std::size_t at = 0; at < bytes.size() && !parser.done(); at += size) {
    waiting += bytes.substr(at, size);
    waiting.erase(0, parser.take(waiting));
  }
  EXPECT_TRUE(parser.done()) << size;
  return parser.incoming();
}

TEST(RequestParserTest, PiecesDoNotMatter) {
  for (std::size_t size = 1; size < 30; ++size) {
    const Incoming whole = parsed_in_pieces(kRequest, size);
    EXPECT_FALSE(whole.refusal.has_value()) << size;
    EXPECT_EQ(whole.request.if_none_match, "\"a\", \"b\"") << size;
    const std::string head = "GET / HTTP/1.1\r\nHost: test\r\n";
    EXPECT_EQ(status_of(parsed_in_pieces(head + "X: a\r\n b\r\n\r\n", size)), 400U) << size;
    EXPECT_EQ(status_of(parsed_in_pieces(head + "X: " + std::string(17'000, 'x'), size)), 431U);
    EXPECT_EQ(status_of(parsed_in_pieces("GET /" + std::string(17'000, 'x'), size)), 414U) << size;
  }
}

TEST(RequestParserTest, HeaderHasItsLimitHoweverItComesIn) {
  ConnectionLimits limits;
  limits.header_bytes = 100;
  for (const std::size_t bytes : {99U, 100U, 101U, 102U, 150U, 500U}) {
    std::string head = "GET / HTTP/1.1\r\nHost: test\r\nX: ";
    head += std::string(bytes - head.size() - 4, 'x') + "\r\n\r\n";
    RequestParser parser(limits);
    parser.take(head);
    EXPECT_EQ(status_of(parser.incoming()), bytes > 100 ? 431U : 0U) << bytes;
    EXPECT_TRUE(parser.done());
  }
}

TEST(RequestParserTest, HalfARequestIsNotDone) {
  const std::string request = kRequest;
  for (std::size_t bytes = 0; bytes < request.size(); ++bytes) {
    RequestParser parser({});
    parser.take(request.substr(0, bytes));
    EXPECT_FALSE(parser.done()) << bytes;
  }
}

TEST(RequestParserTest, BodyHasItsLimit) {
  ConnectionLimits limits;
  limits.body_bytes = 5;
  const std::string head = "POST / HTTP/1.1\r\nHost: test\r\n";
  const std::vector<std::pair<std::string, unsigned>> cases = {
      {"Content-Length: 5\r\n\r\nhello", 0},
      {"Content-Length: 6\r\n\r\nhello!", 413},
      {"Transfer-Encoding: chunked\r\n\r\n3\r\nhel\r\n2\r\nlo\r\n0\r\n\r\n", 0},
      {"Transfer-Encoding: chunked\r\n\r\n3\r\nhel\r\n3\r\nlo!\r\n0\r\n\r\n", 413},
  };
  for (const auto& [rest, status] : cases) {
    RequestParser parser(limits);
    parser.take(head + rest);
    EXPECT_TRUE(parser.done()) << rest;
    EXPECT_EQ(status_of(parser.incoming()), status) << rest;
  }
}

TEST(RequestParserTest, RefusalSaysWhatIsWrong) {
  RequestParser parser({});
  parser.take("POST / HTTP/1.1\r\nHost: test\r\nTransfer-Encoding: gzip\r\n\r\n");
  ASSERT_TRUE(parser.done());
  EXPECT_EQ(status_of(parser.incoming()), 400U);
  EXPECT_FALSE(parser.incoming().keep_alive);
  EXPECT_THAT(*std::get<SharedText>(parser.incoming().refusal->body),
              HasSubstr("Transfer-Encoding other than 'chunked'"));
}

}  // namespace
}  // namespace milepost::server
