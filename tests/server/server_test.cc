#include "server/server.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <atomic>
#include <thread>

#include <nlohmann/json.hpp>

#include "schema/store/sqlite.h"
#include "tests/server/connection.h"
#include "tests/server/server_fixture.h"

namespace milepost::server {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST_F(ServerTest, AnswersOnTheAddressItNames) {
  start();
  EXPECT_EQ(server_->address(), "127.0.0.1:" + std::to_string(port_));
  const Reply reply = fetch(port_, "/v1/maps");
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(nlohmann::json::parse(reply.body).at("maps").at(0).at("build"), town_.build);
  EXPECT_THAT(reply.header("server"), StartsWith("milepost/"));
  EXPECT_THAT(reply.header("date"), HasSubstr(" GMT"));
}

TEST_F(ServerTest, SendsRangesAndTilesAsTheyAreStored) {
  start(300'000);
  const Reply range = fetch(port_, range_path(70, 130));
  EXPECT_EQ(range.status, 200);
  EXPECT_EQ(range.header("content-type"), "application/octet-stream");
  EXPECT_EQ(range.body, frames(1, 2));
  EXPECT_EQ(fetch(port_, segment_path() + "/tiles/tracklets/3").body, frames(3, 3));
  const Reply empty = fetch(port_, range_path(900, 901));
  EXPECT_EQ(empty.status, 200);
  EXPECT_EQ(empty.header("content-length"), "0");
}

TEST_F(ServerTest, SendsCellsAsTheyAreStored) {
  start(300'000);
  const Reply box = fetch(port_, areas_path() + "/walls?bbox=8,49,8.01,49.004");
  EXPECT_EQ(box.status, 200);
  EXPECT_EQ(box.header("content-type"), "application/octet-stream");
  EXPECT_EQ(box.body, std::string(as_text(town_.cells[0])) + std::string(as_text(town_.cells[1])));
  const std::string cell_path = areas_path() + "/walls/" + std::to_string(kTownCells[2]);
  EXPECT_EQ(fetch(port_, cell_path).body, as_text(town_.cells[2]));
  const Reply empty = fetch(port_, areas_path() + "/walls?bbox=1,1,2,2");
  EXPECT_EQ(empty.status, 200);
  EXPECT_EQ(empty.header("content-length"), "0");

  Connection connection(port_);
  connection.send("HEAD " + cell_path + " HTTP/1.1\r\nHost: test\r\n\r\n");
  const Reply head = connection.receive(true);
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.header("content-length"), std::to_string(town_.cells[2].size()));
  connection.send_get(cell_path, "If-None-Match: " + head.header("etag") + "\r\n");
  EXPECT_EQ(connection.receive().status, 304);
}

TEST_F(ServerTest, KeepsTheConnectionOpen) {
  start();
  Connection connection(port_);
  for (int i = 0; i < 3; ++i) {
    connection.send_get("/healthz");
    EXPECT_EQ(connection.receive().body, "ok\n");
    connection.send_get("/v1/maps/nowhere");
    EXPECT_EQ(connection.receive().status, 404);
  }
}

TEST_F(ServerTest, ClosesWhenTheClientWantsThat) {
  start();
  Connection connection(port_);
  connection.send_get("/healthz", "Connection: close\r\n");
  const Reply reply = connection.receive();
  EXPECT_EQ(reply.header("connection"), "close");
  EXPECT_TRUE(connection.closed());
}

TEST_F(ServerTest, AnswersPipelinedRequestsInOrder) {
  start(100'000);
  Connection connection(port_);
  const std::string host = " HTTP/1.1\r\nHost: test\r\n\r\n";
  connection.send("GET " + range_path(0, 200) + host + "GET /healthz" + host + "GET /v1/maps" +
                  host);
  EXPECT_EQ(connection.receive().body, frames(0, 3));
  EXPECT_EQ(connection.receive().body, "ok\n");
  EXPECT_THAT(connection.receive().body, StartsWith("{\"maps\""));
}

TEST_F(ServerTest, TakesARequestInSingleBytes) {
  start();
  Connection connection(port_);
  for (const char c : std::string("GET /healthz HTTP/1.1\r\nHost: test\r\n\r\n")) {
    connection.send({&c, 1});
  }
  EXPECT_EQ(connection.receive().body, "ok\n");
}

TEST_F(ServerTest, HeadHasTheHeaderOfGetAndNoBody) {
  start();
  Connection connection(port_);
  connection.send("HEAD " + range_path(0, 200) + " HTTP/1.1\r\nHost: test\r\n\r\n");
  const Reply head = connection.receive(true);
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.header("content-length"), std::to_string(frames(0, 3).size()));
  connection.send_get(range_path(0, 200));
  const Reply get = connection.receive();
  EXPECT_EQ(get.header("etag"), head.header("etag"));
  EXPECT_EQ(get.body, frames(0, 3));
}

TEST_F(ServerTest, KnownTagIs304AndTheConnectionGoesOn) {
  start();
  const std::string tag = fetch(port_, range_path(0, 200)).header("etag");
  Connection connection(port_);
  connection.send_get(range_path(0, 200), "If-None-Match: \"x\"\r\nIf-None-Match: " + tag + "\r\n");
  const Reply known = connection.receive();
  EXPECT_EQ(known.status, 304);
  EXPECT_EQ(known.header("content-length"), "");
  EXPECT_EQ(known.header("etag"), tag);
  connection.send_get("/healthz");
  EXPECT_EQ(connection.receive().body, "ok\n");
}

TEST_F(ServerTest, OtherMethodIs405AndItsBodyIsPassedOver) {
  start();
  Connection connection(port_);
  connection.send("POST /v1/maps HTTP/1.1\r\nHost: test\r\nContent-Length: 5\r\n\r\nhello");
  const Reply reply = connection.receive();
  EXPECT_EQ(reply.status, 405);
  EXPECT_EQ(reply.header("allow"), "GET, HEAD, OPTIONS");
  connection.send_get("/healthz");
  EXPECT_EQ(connection.receive().body, "ok\n");
}

TEST_F(ServerTest, OldClientIsUnderstood) {
  start();
  Connection connection(port_);
  connection.send("GET /healthz HTTP/1.0\r\n\r\n");
  EXPECT_EQ(connection.receive().body, "ok\n");
  EXPECT_TRUE(connection.closed());
}

// Each of these gets a response, and the connection is then closed.
TEST_F(ServerTest, WhatIsNoRequestIsRefused) {
  start();
  const std::vector<std::pair<std::string, int>> cases = {
      {"hello\r\n\r\n", 400},
      {"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n", 400},
      {"GET / HTTP/9.9\r\nHost: test\r\n\r\n", 400},
      {"GET /healthz HTTP/1.1\r\n\r\n", 400},
      {"GET /healthz HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n", 400},
      {"GET /healthz HTTP/1.1\r\nHost test\r\n\r\n", 400},
      {"GET /healthz HTTP/1.1\r\nHost: test\r\nContent-Length: x\r\n\r\n", 400},
      {"GET /healthz HTTP/1.1\r\nHost: test\r\nContent-Length: 100000\r\n\r\n", 413},
      {"GET /healthz HTTP/1.1\r\nHost: test\r\nX: " + std::string(20'000, 'x') + "\r\n\r\n", 431},
      {"GET /" + std::string(20'000, 'x') + " HTTP/1.1\r\nHost: test\r\n\r\n", 414},
      {"GET /" + std::string(5'000, 'x') + " HTTP/1.1\r\nHost: test\r\nConnection: close\r\n\r\n",
       414},
  };
  for (const auto& [bytes, status] : cases) {
    Connection connection(port_);
    connection.send(bytes);
    const Reply reply = connection.receive();
    EXPECT_EQ(reply.status, status) << bytes.substr(0, 60);
    EXPECT_TRUE(reply.whole);
    EXPECT_EQ(reply.header("content-type"), "application/problem+json");
    EXPECT_EQ(reply.header("connection"), "close");
    EXPECT_TRUE(connection.closed());
  }
  EXPECT_TRUE(serves());
}

// The end of a body must be unambiguous: what one side reads as the body, the other may read as the
// next request (request smuggling). Each of these carries such a request, which must never be
// answered.
TEST_F(ServerTest, FramingInDoubtIsRefusedAndTheRestIsNoRequest) {
  start();
  const std::string smuggled = "GET /v1/maps HTTP/1.1\r\nHost: test\r\n\r\n";
  const std::string chunks = "5\r\nhello\r\n0\r\n\r\n";
  const std::string unknown = "Transfer-Encoding other than 'chunked'";
  const std::string both = "both Content-Length and Transfer-Encoding";
  const std::string length = "Content-Length is not one whole number";
  const std::string twice = "Transfer-Encoding is given more than once";
  const std::string folded = "continues on a second line";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"Transfer-Encoding: xchunked\r\n", unknown},
      {"Transfer-Encoding: gzip\r\n", unknown},
      {"Transfer-Encoding: identity\r\n", unknown},
      {"Transfer-Encoding: gzip, chunked\r\n", unknown},
      {"Transfer-Encoding: chunked, gzip\r\n", unknown},
      {"Transfer-Encoding: chunked, chunked\r\n", unknown},
      {"Transfer-Encoding: chunked,\r\n", unknown},
      {"Transfer-Encoding: ,chunked\r\n", unknown},
      {"Transfer-Encoding: chunked;q=1\r\n", unknown},
      {"Transfer-Encoding: \"chunked\"\r\n", unknown},
      {"Transfer-Encoding: chun ked\r\n", unknown},
      {"Transfer-Encoding:\r\n", unknown},
      {"Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n", twice},
      {"Transfer-Encoding: chunked\r\nTransfer-Encoding: identity\r\n", twice},
      {"Transfer-Encoding: identity\r\nTransfer-Encoding: chunked\r\n", twice},
      {"Transfer-Encoding: x\r\nTransfer-Encoding: y\r\n", twice},
      {"Transfer-Encoding: chunked\r\nContent-Length: 5\r\n", both},
      {"Content-Length: 5\r\nTransfer-Encoding: chunked\r\n", both},
      {"Content-Length: 5\r\ntransfer-encoding: xchunked\r\n", both},
      {"TRANSFER-ENCODING: xchunked\r\ncontent-length: 5\r\n", both},
      {"Transfer-Encoding: gzip\r\nContent-Length: 100000\r\n", both},
      {"Content-Length: 0\r\nContent-Length: 5\r\n", length},
      {"Content-Length: 5\r\nContent-Length: 5\r\n", length},
      {"Content-Length: 5, 5\r\n", length},
      {"Content-Length: 5, 6\r\n", length},
      {"Content-Length: +5\r\n", length},
      {"Content-Length: -5\r\n", length},
      {"Content-Length: 0x5\r\n", length},
      {"Content-Length: 5 5\r\n", length},
      {"Content-Length: 5.0\r\n", length},
      {"Content-Length: 5,\r\n", length},
      {"Content-Length: \"5\"\r\n", length},
      {"Content-Length:\r\n", length},
      {"Content-Length: 18446744073709551617\r\n", length},
      {"Transfer-Encoding:\r\n chunked\r\n", folded},
      {"X: a\r\n\tTransfer-Encoding: chunked\r\n", folded},
      {"X: a\r\n \r\n", folded},
  };
  for (const auto& [fields, detail] : cases) {
    Connection connection(port_);
    connection.send("POST /healthz HTTP/1.1\r\nHost: test\r\n" + fields + "\r\n" + chunks +
                    smuggled);
    const Reply reply = connection.receive();
    EXPECT_EQ(reply.status, 400) << fields;
    EXPECT_TRUE(reply.whole) << fields;
    EXPECT_EQ(reply.header("content-type"), "application/problem+json") << fields;
    EXPECT_EQ(reply.header("connection"), "close") << fields;
    EXPECT_THAT(reply.body, HasSubstr(detail)) << fields;
    EXPECT_TRUE(connection.closed()) << fields;
  }
  EXPECT_TRUE(serves());
}

TEST_F(ServerTest, HttpOneNullHasNoChunks) {
  start();
  Connection connection(port_);
  connection.send(
      "POST /healthz HTTP/1.0\r\nConnection: keep-alive\r\nTransfer-Encoding: chunked\r\n\r\n"
      "0\r\n\r\nGET /v1/maps HTTP/1.0\r\n\r\n");
  const Reply reply = connection.receive();
  EXPECT_EQ(reply.status, 400);
  EXPECT_THAT(reply.body, HasSubstr("HTTP/1.0 has no Transfer-Encoding"));
  EXPECT_TRUE(connection.closed());
}

TEST_F(ServerTest, ChunkedBodyIsPassedOver) {
  start();
  for (const char* coding : {"chunked", "Chunked", "CHUNKED", "\t chunked \t"}) {
    Connection connection(port_);
    connection.send(std::string("POST /healthz HTTP/1.1\r\nHost: test\r\nTransfer-Encoding:") +
                    coding + "\r\n\r\n5;a=b\r\nhello\r\n0\r\nIf-None-Match: *\r\n\r\n");
    EXPECT_EQ(connection.receive().status, 405) << coding;
    connection.send_get("/healthz");
    EXPECT_EQ(connection.receive().body, "ok\n") << coding;
  }
}

// A field after the body is not a field of the request.
TEST_F(ServerTest, TrailersChangeNothing) {
  start();
  Connection connection(port_);
  connection.send(
      "GET /v1/maps HTTP/1.1\r\nHost: test\r\nTransfer-Encoding: chunked\r\n\r\n"
      "0\r\nIf-None-Match: *\r\nHost: other\r\n\r\n");
  EXPECT_EQ(connection.receive().status, 200);
  connection.send_get("/healthz");
  EXPECT_EQ(connection.receive().body, "ok\n");
}

TEST_F(ServerTest, ChunksThatAreNoneAreRefused) {
  start();
  for (const std::string& body :
       {std::string("x\r\nhello\r\n0\r\n\r\n"), std::string("-5\r\nhello\r\n0\r\n\r\n"),
        std::string("0x5\r\nhello\r\n0\r\n\r\n"), std::string("5\nhello\r\n0\r\n\r\n"),
        std::string("5\r\nhelloX\r\n0\r\n\r\n"), std::string("5;\n\r\nhello\r\n0\r\n\r\n"),
        std::string("10000000000000005\r\nhello\r\n0\r\n\r\n"),
        std::string("0\r\nContent-Length: 5\r\n\r\n"), std::string("0\r\nbad field\r\n\r\n")}) {
    Connection connection(port_);
    connection.send("POST /healthz HTTP/1.1\r\nHost: test\r\nTransfer-Encoding: chunked\r\n\r\n" +
                    body);
    EXPECT_EQ(connection.receive().status, 400) << body;
    EXPECT_TRUE(connection.closed()) << body;
  }
}

TEST_F(ServerTest, HeadersThatOthersMayReadOtherwiseAreRefused) {
  start();
  const std::string zero(1, '\0');
  const std::vector<std::string> heads = {
      "GET /healthz HTTP/1.1\r\nHost : test\r\n\r\n",
      "GET /healthz HTTP/1.1\r\nHost: test\r\nTransfer-Encoding : chunked\r\n\r\n",
      "GET /healthz HTTP/1.1\r\n Host: test\r\n\r\n",
      "GET /healthz HTTP/1.1\r\nHost: test\r\n: x\r\n\r\n",
      "GET /healthz HTTP/1.1\nHost: test\n\n\r\n\r\n",
      "GET /healthz HTTP/1.1\r\nHost: test\nX: y\r\n\r\n",
      "GET /healthz HTTP/1.1\r\nHost: te\rst\r\n\r\n",
      "GET /healthz HTTP/1.1\r\nHost: test\r\rX: y\r\n\r\n",
      "GET /healthz HTTP/1.1\r\nHost: te" + zero + "st\r\n\r\n",
      "GET /healthz HTTP/1.1\r\nHost: test\r\nX" + zero + ": y\r\n\r\n",
      "GET /heal" + zero + "thz HTTP/1.1\r\nHost: test\r\n\r\n",
      "GET  /healthz HTTP/1.1\r\nHost: test\r\n\r\n",
      "GET /healthz  HTTP/1.1\r\nHost: test\r\n\r\n",
      "GET /healthz HTTP/1.1 \r\nHost: test\r\n\r\n",
      "GET\t/healthz HTTP/1.1\r\nHost: test\r\n\r\n",
      "GET /healthz\r\nHost: test\r\n\r\n",
      "GET /healthz http/1.1\r\nHost: test\r\n\r\n",
      "GET /healthz HTTP/1.0\r\nHost: a\r\nHost: b\r\n\r\n",
  };
  for (const std::string& head : heads) {
    Connection connection(port_);
    connection.send(head + "GET /v1/maps HTTP/1.1\r\nHost: test\r\n\r\n");
    const Reply reply = connection.receive();
    EXPECT_EQ(reply.status, 400) << head;
    EXPECT_EQ(reply.header("content-type"), "application/problem+json") << head;
    EXPECT_TRUE(connection.closed()) << head;
  }
  EXPECT_TRUE(serves());
}

// The limit applies to the whole header, however it is received.
TEST_F(ServerTest, HeaderInPiecesHasTheSameLimit) {
  start();
  Connection connection(port_);
  connection.send("GET /healthz HTTP/1.1\r\nHost: test\r\n");
  for (int i = 0; i < 19; ++i) {
    connection.send("X: " + std::string(1000, 'x') + "\r\n");
    std::this_thread::sleep_for(5ms);
  }
  connection.send("\r\n");
  EXPECT_EQ(connection.receive().status, 431);
  EXPECT_TRUE(connection.closed());
}

TEST_F(ServerTest, RefusedClientMayGoOnSending) {
  ConnectionLimits limits;
  limits.lingering_close = 1h;
  start(1000, limits);
  Connection connection(port_);
  connection.send("GET /healthz HTTP/1.1\r\nHost: test\r\nContent-Length: 100000\r\n\r\n");
  EXPECT_EQ(connection.receive().status, 413);
  for (int i = 0; i < 10; ++i) {  // a socket that is already closed would respond with a reset
    EXPECT_TRUE(connection.send(std::string(10'000, 'x')));
    std::this_thread::sleep_for(5ms);
  }
}

TEST_F(ServerTest, HalfARequestIs408InTime) {
  ConnectionLimits limits;
  limits.request = 200ms;
  start(1000, limits);
  Connection connection(port_);
  connection.send("GET /healthz HTTP/1.1\r\nHo");
  const Reply reply = connection.receive();
  EXPECT_EQ(reply.status, 408);
  EXPECT_THAT(reply.body, HasSubstr("\"title\":\"Request Timeout\",\"status\":408"));
  EXPECT_EQ(reply.header("content-type"), "application/problem+json");
  EXPECT_EQ(reply.header("connection"), "close");
  EXPECT_TRUE(reply.whole);
  EXPECT_TRUE(connection.closed());
  EXPECT_TRUE(serves());
}

TEST_F(ServerTest, DrippingRequestIsClosedInTime) {
  ConnectionLimits limits;
  limits.request = 300ms;
  start(1000, limits);
  Connection connection(port_);
  connection.send("GET /healthz HTTP/1.1\r\n");
  // With a byte every 20 ms an idle timeout would never expire.
  bool open = true;
  for (int i = 0; i < 3000 && open; ++i) {
    open = connection.send("x");
    std::this_thread::sleep_for(20ms);
  }
  EXPECT_FALSE(open);
}

TEST_F(ServerTest, SilentConnectionIsClosedInTime) {
  ConnectionLimits limits;
  limits.idle = 200ms;
  start(1000, limits);
  Connection connection(port_);
  connection.send_get("/healthz");
  EXPECT_EQ(connection.receive().body, "ok\n");
  EXPECT_TRUE(connection.closed());
}

TEST_F(ServerTest, ClientThatStopsReadingIsBrokenOff) {
  ConnectionLimits limits;
  limits.stall = 300ms;
  limits.connections = 1;
  start(16'000'000, limits);
  Connection connection(port_, 4096);
  connection.send_get(range_path(0, 200));
  EXPECT_EQ(connection.read(8), "HTTP/1.1");
  EXPECT_TRUE(becomes_free());  // the only slot is taken until the server releases it
  EXPECT_LT(connection.read(100'000'000).size(), frames(0, 3).size());
}

TEST_F(ServerTest, ManyClientsAtOnceGetTheirBytes) {
  start(200'000);
  const std::string all = frames(0, 3);
  const std::string middle = frames(1, 2);
  std::atomic<int> good = 0;
  std::vector<std::thread> clients;
  clients.reserve(16);
  for (int i = 0; i < 16; ++i) {
    clients.emplace_back([&, i] {
      Connection connection(port_);
      for (int request = 0; request < 5; ++request) {
        const bool whole = (i + request) % 2 == 0;
        connection.send_get(whole ? range_path(0, 200) : range_path(70, 130));
        if (connection.receive().body == (whole ? all : middle)) ++good;
      }
    });
  }
  for (auto& client : clients) client.join();
  EXPECT_EQ(good, 16 * 5);
}

TEST_F(ServerTest, ClientThatLeavesInTheMiddleDoesNoHarm) {
  start(4'000'000);
  for (int i = 0; i < 10; ++i) {
    Connection connection(port_, 4096);
    connection.send_get(range_path(0, 200));
    EXPECT_EQ(connection.read(1000).size(), 1000U);
  }
  EXPECT_EQ(fetch(port_, range_path(0, 10)).body, frames(0, 0));
}

TEST_F(ServerTest, AcceptingGoesOnAfterErrors) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the undefined behaviour sanitizer needs file descriptors for its own checks";
#endif
  start();
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  Connection connection;
  // The client's socket exists; no further one can be created, so the server cannot accept.
  rlimit none = before;
  none.rlim_cur = 3;
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  const bool connected = connection.connect(port_);
  std::this_thread::sleep_for(300ms);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
  ASSERT_TRUE(connected);
  connection.send_get("/healthz");
  EXPECT_EQ(connection.receive().status, 200);
}

// Damages the encoded tile of tile `index` in the file that the server has open.
void damage_tile(const std::filesystem::path& file, int index) {
  auto database = sqlite::Database::open(file, sqlite::Access::read_write);
  const Status damaged = database->execute(
      "UPDATE frames SET frame = zeroblob(length(frame)) WHERE id = (SELECT frame FROM tiles WHERE "
      "layer = 'tracklets' AND number = " +
      std::to_string(index) + ")");
  ASSERT_TRUE(damaged.ok());
}

TEST_F(ServerTest, DamagedFirstTileIs500) {
  start(100'000);
  damage_tile(folder_.path() / "town.map", 1);
  const Reply reply = fetch(port_, range_path(70, 130));
  EXPECT_EQ(reply.status, 500);
  EXPECT_EQ(reply.header("content-type"), "application/problem+json");
  EXPECT_TRUE(reply.whole);
  EXPECT_TRUE(serves());
}

TEST_F(ServerTest, DamagedLaterTileBreaksTheAnswerOff) {
  start(100'000);
  damage_tile(folder_.path() / "town.map", 2);
  const Reply reply = fetch(port_, range_path(0, 200));
  EXPECT_EQ(reply.status, 200);
  EXPECT_FALSE(reply.whole);
  EXPECT_EQ(reply.body, frames(0, 1));
  EXPECT_TRUE(serves());
}

}  // namespace
}  // namespace milepost::server
