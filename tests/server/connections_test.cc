// Limits on connections, requests that take long, and stops.
#include <gmock/gmock.h>

#include <atomic>
#include <thread>
#include <vector>

#include "tests/server/server_fixture.h"
#include "tests/server/slow_disk.h"

namespace milepost::server {
namespace {

using namespace std::chrono_literals;

constexpr const char* kHealth = "GET /healthz HTTP/1.1\r\nHost: test\r\n\r\n";
constexpr const char* kHalf = "GET /healthz HTTP/1.1\r\nHo";

class ConnectionsTest : public ServerTest {
 protected:
  void start_with_limit(std::size_t connections, std::size_t per_address) {
    ConnectionLimits limits;
    limits.connections = connections;
    limits.per_address = per_address;
    start(1000, limits);
  }
  bool accepts() const {
    Connection connection;
    return connection.connect(port_);
  }
  static void expect_ok(Connection& connection) {
    connection.send(kHealth);
    EXPECT_EQ(connection.receive().body, "ok\n");
  }
};

void expect_rejected(Connection& connection) {
  const Reply busy = connection.receive();
  EXPECT_EQ(busy.status, 503);
  EXPECT_EQ(busy.header("retry-after"), "1");
  EXPECT_EQ(busy.header("content-type"), "application/problem+json");
  EXPECT_EQ(busy.header("connection"), "close");
  EXPECT_TRUE(busy.whole);
  EXPECT_TRUE(connection.closed());
}

TEST_F(ConnectionsTest, TooManyAreRejectedAndLaterServed) {
  start_with_limit(2, 2);
  {
    Connection first(port_);
    Connection second(port_);
    for (Connection* connection : {&first, &second}) {
      expect_ok(*connection);  // shows that it is counted
      connection->send(kHalf);
    }
    Connection third(port_);
    expect_rejected(third);
    first.send("st: test\r\n\r\n");
    EXPECT_EQ(first.receive().status, 200);
  }
  EXPECT_TRUE(becomes_free());
}

TEST_F(ConnectionsTest, LongestIdleOneMakesRoom) {
  // One thread, so that connections are taken in the order in which they came.
  ServerSettings settings;
  settings.threads = 1;
  settings.limits.connections = 3;
  settings.limits.per_address = 10;
  start(settings);
  Connection busy(port_);
  busy.send(kHalf);
  Connection silent(port_);  // never says a word
  Connection idle(port_);
  expect_ok(idle);
  Connection fresh(port_);
  expect_ok(fresh);
  EXPECT_TRUE(silent.closed());
  expect_ok(idle);
  busy.send("st: test\r\n\r\n");
  EXPECT_EQ(busy.receive().status, 200);
}

TEST_F(ConnectionsTest, SilentOnesShutNobodyOut) {
  start_with_limit(50, 1000);
  std::vector<std::unique_ptr<Connection>> silent;
  for (int i = 0; i < 200; ++i) silent.push_back(std::make_unique<Connection>(port_));
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(serves());
}

TEST_F(ConnectionsTest, OneAddressLeavesRoomForOthers) {
  start_with_limit(10, 3);
  std::vector<std::unique_ptr<Connection>> greedy;
  for (int i = 0; i < 3; ++i) {
    greedy.push_back(std::make_unique<Connection>(port_));
    greedy.back()->send(kHalf);
  }
  Connection one_more(port_);
  expect_rejected(one_more);
  Connection other(port_, "127.0.0.2");
  expect_ok(other);
  greedy.clear();
  EXPECT_TRUE(becomes_free());
}

TEST_F(ConnectionsTest, ConnectionsHaveDescriptorsLeftForMaps) {
  ServerSettings settings;
  settings.limits.connections = 1'000'000'000;  // lowered to what there is
  start(settings);
  EXPECT_TRUE(serves());
}

TEST_F(ConnectionsTest, ThousandPipelinedRequestsAreAnsweredInOrder) {
  start(2000);
  Connection connection(port_);
  const std::string host = " HTTP/1.1\r\nHost: test\r\n\r\n";
  std::string requests;
  for (int i = 0; i < 1000; ++i) {
    requests += "GET " + segment_path() + "/tiles/tracklets/" + std::to_string(i % 4) + host;
  }
  std::thread sending([&] { connection.send(requests); });
  for (std::size_t i = 0; i < 1000; ++i) ASSERT_EQ(connection.receive().body, frames(i % 4, i % 4));
  sending.join();
}

TEST_F(ConnectionsTest, EmptyLinesBeforeARequestAreSkipped) {
  start();
  Connection connection(port_);
  connection.send(std::string("\r\n") + kHealth + "\r\n\r\n" + kHealth);
  EXPECT_EQ(connection.receive().body, "ok\n");
  EXPECT_EQ(connection.receive().body, "ok\n");
  for (const char c : std::string("\r\n\r\n") + kHealth) connection.send({&c, 1});
  EXPECT_EQ(connection.receive().body, "ok\n");
  std::string endless;
  for (int i = 0; i < 100; ++i) endless += "\r\n";
  connection.send(endless + kHealth);
  EXPECT_EQ(connection.receive().status, 400);
}

TEST_F(ConnectionsTest, BodyIsAskedForOnce) {
  start();
  Connection connection(port_);
  const std::string head = "POST /v1/maps HTTP/1.1\r\nHost: test\r\n";
  connection.send(head + "Content-Length: 5\r\nExpect: 100-Continue\r\n\r\n");
  EXPECT_EQ(connection.receive(true).status, 100);
  connection.send("he");
  std::this_thread::sleep_for(20ms);
  connection.send("llo");
  EXPECT_EQ(connection.receive().status, 405);
  // A client that sends the body at once is not asked.
  connection.send(head + "Content-Length: 5\r\nExpect: 100-continue\r\n\r\nhello");
  EXPECT_EQ(connection.receive().status, 405);
  // The answer comes without the body where it is too long.
  connection.send(head + "Content-Length: 100000\r\nExpect: 100-continue\r\n\r\n");
  EXPECT_EQ(connection.receive().status, 413);
}

TEST_F(ConnectionsTest, ClientThatEndsItsSideGetsItsAnswer) {
  start(100'000);
  Connection connection(port_);
  connection.send_get(range_path(0, 200));
  connection.end_sending();
  EXPECT_EQ(connection.receive().body, frames(0, 3));
  EXPECT_TRUE(connection.closed());
}

TEST_F(ConnectionsTest, ResetsDoNoHarm) {
  start(4'000'000);
  for (int i = 0; i < 50; ++i) {
    Connection connection(port_, 4096);
    if (i % 3 == 0) connection.send(kHalf);
    if (i % 3 == 1) connection.send_get(range_path(0, 200));
    if (i % 6 == 1) connection.read(1000);
    connection.reset();
  }
  EXPECT_EQ(fetch(port_, range_path(0, 200)).body, frames(0, 3));
}

TEST_F(ConnectionsTest, ReloadedCatalogIsServedAtOnce) {
  town_ = write_town(folder_.path() / "town.map");
  const auto current = std::make_shared<CurrentCatalog>(open_catalog(folder_.path()));
  auto server = Server::start(current, {});
  ASSERT_TRUE(server.ok());
  server_ = std::move(*server);
  port_ = server_->port();
  const std::string old_tile = segment_path() + "/tiles/tracklets/1";
  const std::string old_document = fetch(port_, "/v1/maps/town").body;
  EXPECT_EQ(fetch(port_, old_tile).body, frames(1, 1));
  const TownMap next = write_town(folder_.path() / "town.map", 1000, 2);
  const std::weak_ptr<const Catalog> old = current->now();
  current->replace(open_catalog(folder_.path()));
  EXPECT_EQ(fetch(port_, old_tile).status, 410);
  EXPECT_NE(fetch(port_, "/v1/maps/town").body, old_document);
  town_ = next;
  EXPECT_EQ(fetch(port_, segment_path() + "/tiles/tracklets/1").body, frames(1, 1));
  EXPECT_TRUE(old.expired());  // its files are closed
}

class SlowDiskTest : public ConnectionsTest {
 protected:
  void start_slow(const ServerSettings& settings) {
    start(settings, 100'000);
    EXPECT_EQ(fetch(port_, hot_path()).body, frames(0, 0));
    disk_.block();
  }
  std::string hot_path() const { return segment_path() + "/tiles/tracklets/0"; }
  std::string cold_path() const { return segment_path() + "/tiles/tracklets/2"; }

  SlowDisk disk_;
};

TEST_F(SlowDiskTest, HoldsUpNothingButItsReaders) {
  ServerSettings settings;
  settings.disk_threads = 2;
  start_slow(settings);
  std::vector<std::unique_ptr<Connection>> readers;
  for (int i = 0; i < 10; ++i) {
    readers.push_back(std::make_unique<Connection>(port_));
    readers.back()->send_get(cold_path());
  }
  ASSERT_TRUE(disk_.wait_blocked(2));
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(serves());
  EXPECT_EQ(fetch(port_, "/readyz").status, 200);
  EXPECT_EQ(fetch(port_, "/v1/maps").status, 200);
  EXPECT_EQ(fetch(port_, hot_path()).body, frames(0, 0));
  disk_.release();
  for (const auto& reader : readers) EXPECT_EQ(reader->receive().body, frames(2, 2));
}

TEST_F(SlowDiskTest, MoreThanItsQueueAre503) {
  ServerSettings settings;
  settings.disk_threads = 1;
  settings.disk_queue = 2;
  start_slow(settings);
  Connection reader(port_);
  reader.send_get(cold_path());
  ASSERT_TRUE(disk_.wait_blocked(1));
  std::atomic<int> busy = 0;
  std::atomic<int> served = 0;
  std::vector<std::thread> clients;
  for (int i = 0; i < 5; ++i) {
    clients.emplace_back([&] {
      const Reply reply = fetch(port_, cold_path());
      if (reply.body == frames(2, 2)) ++served;
      if (reply.status == 503 && reply.header("retry-after") == "1") ++busy;
    });
  }
  while (busy < 3) std::this_thread::sleep_for(1ms);
  EXPECT_EQ(served, 0);
  disk_.release();
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(busy, 3);
  EXPECT_EQ(served, 2);
  EXPECT_EQ(reader.receive().body, frames(2, 2));
}

TEST_F(SlowDiskTest, ClientThatLeftIsForgotten) {
  ServerSettings settings;
  settings.disk_threads = 1;
  start_slow(settings);
  {
    Connection reader(port_);
    reader.send_get(cold_path());
    ASSERT_TRUE(disk_.wait_blocked(1));
    reader.reset();
  }
  disk_.release();
  EXPECT_EQ(fetch(port_, cold_path()).body, frames(2, 2));
}

TEST_F(SlowDiskTest, StopLetsWhatIsReadBeSent) {
  ServerSettings settings;
  settings.limits.drain = 1h;
  start_slow(settings);
  Connection reader(port_);
  reader.send_get(cold_path());
  ASSERT_TRUE(disk_.wait_blocked(1));
  std::thread stopping([this] { server_->stop(); });
  std::this_thread::sleep_for(50ms);
  disk_.release();
  const Reply reply = reader.receive();
  EXPECT_EQ(reply.body, frames(2, 2));
  EXPECT_EQ(reply.header("connection"), "close");
  stopping.join();
}

TEST_F(ConnectionsTest, StopEndsIdleConnectionsAtOnce) {
  ConnectionLimits limits;
  limits.drain = 1h;
  start(1000, limits);
  Connection connection(port_);
  connection.send_get("/healthz");
  EXPECT_EQ(connection.receive().status, 200);
  server_->stop();
  EXPECT_TRUE(connection.closed());
  EXPECT_THROW(Connection late(port_), std::runtime_error);
  server_->stop();
}

TEST_F(ConnectionsTest, StopLetsAnAnswerUnderWayEnd) {
  ConnectionLimits limits;
  limits.drain = 30s;
  start(4'000'000, limits);
  Connection connection(port_, 4096);
  connection.send_get(range_path(0, 200));
  EXPECT_EQ(connection.read(4), "HTTP");
  std::thread stopping([this] { server_->stop(); });
  const std::string rest = connection.read(100'000'000);
  stopping.join();
  EXPECT_TRUE(rest.ends_with(frames(0, 3)));
}

TEST_F(ConnectionsTest, StopBreaksOffAnAnswerThatDoesNotEnd) {
  ConnectionLimits limits;
  limits.drain = 100ms;
  start(16'000'000, limits);
  Connection connection(port_, 4096);
  connection.send_get(range_path(0, 200));
  EXPECT_EQ(connection.read(4), "HTTP");
  server_->stop();
  EXPECT_LT(connection.read(100'000'000).size(), frames(0, 3).size());
}

TEST_F(ConnectionsTest, StopAnswersWhatHasConnected) {
  ConnectionLimits limits;
  limits.drain = 1h;
  limits.last_request = 30s;
  start(1000, limits);
  Connection open(port_);
  expect_ok(open);
  Connection half(port_);
  half.send(kHalf);
  std::vector<std::unique_ptr<Connection>> fresh;
  for (int i = 0; i < 50; ++i) {
    fresh.push_back(std::make_unique<Connection>(port_));
    fresh.back()->send(kHealth);
  }
  std::thread stopping([this] { server_->stop(); });
  for (const auto& connection : fresh) EXPECT_EQ(connection->receive().body, "ok\n");
  fresh.clear();
  while (accepts()) std::this_thread::sleep_for(10ms);
  std::this_thread::sleep_for(50ms);  // the sockets are closed first, then the workers are told
  half.send("st: test\r\n\r\n");
  EXPECT_EQ(half.receive().body, "ok\n");
  open.send(std::string(kHealth) + kHealth);  // on its way when the server stops
  EXPECT_EQ(open.receive().body, "ok\n");
  const Reply last = open.receive();
  EXPECT_EQ(last.body, "ok\n");
  EXPECT_EQ(last.header("connection"), "close");
  EXPECT_TRUE(open.closed());
  half.reset();
  stopping.join();
}

// Each client sends one request after the other until it is told that the last one was answered.
TEST_F(ConnectionsTest, StopUnderLoadBreaksNothing) {
  start(20'000);
  std::atomic<int> answered = 0;
  std::atomic<int> broken = 0;
  std::vector<std::unique_ptr<Connection>> connections;
  for (int i = 0; i < 16; ++i) connections.push_back(std::make_unique<Connection>(port_));
  std::vector<std::thread> clients;
  for (std::size_t i = 0; i < connections.size(); ++i) {
    clients.emplace_back([&, i] {
      Connection& connection = *connections[i];
      for (bool open = true; open;) {
        connection.send_get(segment_path() + "/tiles/tracklets/" + std::to_string(i % 4));
        const Reply reply = connection.receive();
        ++(reply.body == frames(i % 4, i % 4) ? answered : broken);
        open = reply.whole && reply.header("connection") != "close";
      }
    });
  }
  while (answered < 200) std::this_thread::sleep_for(1ms);
  server_->stop();
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(broken, 0);
}

}  // namespace
}  // namespace milepost::server
