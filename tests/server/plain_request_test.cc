#include "server/http/plain_request.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "server/http/request_reader.h"

namespace milepost::server {
namespace {

const std::string kGet = "GET /v1/maps HTTP/1.1\r\n";

std::size_t taken_of(const std::string& bytes, Incoming& incoming) {
  return take_plain_request(bytes, {}, incoming);
}

// What the fast path takes, the parser takes in the same way. Returns whether it takes it.
bool agree(const std::string& bytes) {
  Incoming plain;
  const std::size_t taken = taken_of(bytes, plain);
  if (taken == 0) return false;
  RequestParser parser({});
  EXPECT_EQ(parser.take(bytes), taken) << bytes;
  EXPECT_TRUE(parser.done()) << bytes;
  const Incoming& full = parser.incoming();
  EXPECT_FALSE(full.refusal.has_value()) << bytes;
  EXPECT_TRUE(plain.request == full.request) << bytes;
  EXPECT_EQ(plain.http_version, full.http_version) << bytes;
  EXPECT_EQ(plain.keep_alive, full.keep_alive) << bytes;
  return true;
}

TEST(PlainRequestTest, OrdinaryRequestsAreTaken) {
  for (const std::string& request :
       {kGet + "Host: h\r\n\r\n", std::string("HEAD /a?b=c&d=%31 HTTP/1.1\r\nhost:h:80\r\n\r\n"),
        kGet + "Host: h\r\nConnection: Keep-Alive\r\n\r\n",
        kGet + "Host: h\r\nconnection: CLOSE\r\n\r\n",
        kGet + "Host: h\r\nIf-None-Match:   \"a\", W/\"b\"  \r\n\r\n",
        kGet + "Host: h\r\nRange: bytes=0-1\r\nIf-Range: \"a\"\r\nOrigin: https://a.b\r\n\r\n",
        kGet + "Host: h\r\nAccept-Encoding: gzip, zstd;q=0.5\r\nAuthorization: Bearer a\r\n\r\n",
        kGet + "Host:\r\nAccept: */*\r\nUser-Agent: x/1 (y; z)\r\n\r\n",
        kGet + "Host: h\r\nX_y: a\r\nX_y: b\r\n\r\nGET /"}) {
    EXPECT_TRUE(agree(request)) << request;
  }
}

TEST(PlainRequestTest, EverythingElseIsLeftToTheParser) {
  Incoming incoming;
  for (const std::string& request :
       {std::string(),
        kGet,
        kGet + "Host: h\r\n",
        kGet + "\r\n",
        "\r\n" + kGet + "Host: h\r\n\r\n",
        kGet + "Host: h\r\nHost: h\r\n\r\n",
        kGet + "Host : h\r\n\r\n",
        kGet + "Host: h\r\n folded\r\n\r\n",
        kGet + "Host: h\r\nX: a\tb\r\n\r\n",
        kGet + "Host: h\r\nX: \xc3\xa4\r\n\r\n",
        kGet + "Host: h\nX: a\r\n\r\n",
        kGet + "Host: h\r\nContent-Length: 0\r\n\r\n",
        kGet + "Host: h\r\nTransfer-Encoding: chunked\r\n\r\n",
        kGet + "Host: h\r\nExpect: 100-continue\r\n\r\n",
        kGet + "Host: h\r\nUpgrade: x\r\n\r\n",
        kGet + "Host: h\r\nConnection: close, x\r\n\r\n",
        kGet + "Host: h\r\nConnection: close\r\nConnection: keep-alive\r\n\r\n",
        kGet + "Host: h\r\nIf-None-Match: \"a\"\r\nIf-None-Match: \"b\"\r\n\r\n",
        std::string("GET /v1/maps HTTP/1.0\r\nHost: h\r\n\r\n"),
        std::string("POST /v1/maps HTTP/1.1\r\nHost: h\r\n\r\n"),
        std::string("get /v1/maps HTTP/1.1\r\nHost: h\r\n\r\n"),
        std::string("GET http://h/v1/maps HTTP/1.1\r\nHost: h\r\n\r\n"),
        std::string("GET  /v1/maps HTTP/1.1\r\nHost: h\r\n\r\n"),
        std::string("GET /v1/maps  HTTP/1.1\r\nHost: h\r\n\r\n"),
        kGet + "Host: h\r\nX: " + std::string(17'000, 'x') + "\r\n\r\n"}) {
    EXPECT_EQ(taken_of(request, incoming), 0U) << request;
  }
}

// Requests with bytes changed, taken away and put in, at random but the same each time.
TEST(PlainRequestTest, AgreesWithTheParserOnDamagedRequests) {
  const std::vector<std::string> requests = {
      kGet + "Host: h\r\nIf-None-Match: \"a\"\r\nConnection: close\r\n\r\n",
      "HEAD /x?y=z HTTP/1.1\r\nHost: h\r\nConnection: keep-alive\r\nX: y\r\n\r\n"};
  const std::string bytes = std::string("\r\n \t:/?%\"\\,;xhH0", 15) + '\0' + '\x80';
  std::mt19937 random(1);
  const auto below = [&random](std::size_t limit) { return random() % limit; };
  int taken = 0;
  for (int i = 0; i < 100'000; ++i) {
    std::string request = requests[below(requests.size())];
    for (std::size_t changes = below(3); changes < 3; ++changes) {
      const std::size_t at = below(request.size());
      const char byte = bytes[below(bytes.size())];
      const std::size_t kind = below(3);
      if (kind == 0) request[at] = byte;
      if (kind == 1) request.erase(at, 1);
      if (kind == 2) request.insert(at, 1, byte);
    }
    taken += agree(request) ? 1 : 0;
  }
  EXPECT_GT(taken, 1000);
}

// The requests that a reader finds in bytes that arrive in pieces of `size`.
std::vector<std::string> read_in_pieces(const std::string& bytes, std::size_t size) {
  const ConnectionLimits limits;
  RequestReader reader(limits);
  Incoming incoming;
  std::vector<std::string> found;
  for (std::size_t at = 0; at < bytes.size(); at += size) {
    const std::string piece = bytes.substr(at, size);  // gone after keep()
    reader.add(piece);
    while (reader.next(incoming)) {
      if (incoming.refusal) return found;
      found.push_back(incoming.request.method + ' ' + incoming.request.target + ' ' +
                      incoming.request.if_none_match);
    }
    reader.keep();
  }
  EXPECT_TRUE(reader.empty());
  return found;
}

TEST(RequestReaderTest, PiecesDoNotMatter) {
  const std::string bytes =
      kGet + "Host: h\r\n\r\n\r\nPOST /p HTTP/1.1\r\nHost: h\r\n" + "Content-Length: 2\r\n\r\nab" +
      kGet + "Host: h\r\nIf-None-Match: \"a\"\r\n\r\n" + "HEAD /h HTTP/1.0\r\n\r\n\r\n";
  const std::vector<std::string> expected = {"GET /v1/maps ", "POST /p ", "GET /v1/maps \"a\"",
                                             "HEAD /h "};
  for (std::size_t size = 1; size <= bytes.size(); ++size) {
    EXPECT_EQ(read_in_pieces(bytes, size), expected) << size;
  }
}

TEST(RequestReaderTest, BodyIsAskedForOnce) {
  const ConnectionLimits limits;
  RequestReader reader(limits);
  Incoming incoming;
  const std::string head =
      "POST /p HTTP/1.1\r\nHost: h\r\nContent-Length: 2\r\nExpect: 100-continue\r\n\r\n";
  reader.add(head);
  EXPECT_FALSE(reader.next(incoming));
  EXPECT_TRUE(reader.wants_continue());
  EXPECT_FALSE(reader.wants_continue());
  EXPECT_FALSE(reader.empty());
  reader.add("ab");
  EXPECT_TRUE(reader.next(incoming));
  EXPECT_TRUE(reader.empty());
  EXPECT_FALSE(reader.wants_continue());
}

}  // namespace
}  // namespace milepost::server
