// Where the server listens, and what it hears from and tells a service manager.
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

#include "server/listen/admission.h"
#include "server/listen/descriptor_limit.h"
#include "server/listen/listening_socket.h"
#include "server/listen/service_manager.h"
#include "tests/server/server_fixture.h"

namespace milepost::server {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(ListenAddressTest, IsHostAndPortOrAPath) {
  const auto parsed = [](std::string_view text) { return *parse_listen_address(text); };
  EXPECT_EQ(parsed("127.0.0.1:8080").host, "127.0.0.1");
  EXPECT_EQ(parsed("127.0.0.1:8080").port, 8080);
  EXPECT_EQ(parsed("[::1]:0").host, "::1");
  EXPECT_EQ(parsed("localhost:65535").host, "localhost");
  EXPECT_EQ(parsed("unix:/run/m.sock").unix_path, "/run/m.sock");
  for (const std::string text :
       {"8080", "127.0.0.1", "127.0.0.1:", ":80", "127.0.0.1:65536", "::1:80", "127.0.0.1:-1",
        "127.0.0.1:80x", "unix:", "[::1]", "[::1]80"}) {
    const auto address = parse_listen_address(text);
    ASSERT_FALSE(address.ok()) << text;
    EXPECT_THAT(address.error().line(), StartsWith("address " + text + ": "));
  }
  EXPECT_FALSE(parse_listen_address("unix:/" + std::string(200, 'x')).ok());
}

using ListenTest = ServerTest;

ServerSettings listening_on(const ListenAddress& address) {
  ServerSettings settings;
  settings.listen = {address};
  return settings;
}

TEST_F(ListenTest, AddressInUseIsAnError) {
  start();
  const auto second =
      Server::start(served(open_catalog(folder_.path())), listening_on({"127.0.0.1", port_}));
  ASSERT_FALSE(second.ok());
  EXPECT_THAT(second.error().line(), HasSubstr(server_->address() + ": cannot be listened on"));
}

TEST_F(ListenTest, NameThatIsNoneIsAnError) {
  const auto server = Server::start(served(open_catalog(folder_.path())),
                                    listening_on({"no.such.host.invalid", 0}));
  ASSERT_FALSE(server.ok());
  EXPECT_THAT(server.error().line(), HasSubstr("address no.such.host.invalid: cannot be resolved"));
}

TEST_F(ListenTest, AddressOfAnotherHostIsAnError) {
  const auto server =
      Server::start(served(open_catalog(folder_.path())), listening_on({"192.0.2.1", 0}));
  ASSERT_FALSE(server.ok());
  EXPECT_THAT(server.error().line(), HasSubstr("192.0.2.1:0: cannot be listened on"));
}

TEST_F(ListenTest, NoAddressIsAnError) {
  ServerSettings settings;
  settings.listen.clear();
  const auto server = Server::start(served(open_catalog(folder_.path())), settings);
  ASSERT_FALSE(server.ok());
  EXPECT_THAT(server.error().line(), HasSubstr("no address to listen on"));
}

TEST_F(ListenTest, NameStandsForItsAddresses) {
  start(listening_on({"localhost", 0}));
  EXPECT_TRUE(serves());
  EXPECT_GE(server_->addresses().size(), 1U);
  for (const std::string& address : server_->addresses()) {
    EXPECT_THAT(address, EndsWith(':' + std::to_string(port_)));
  }
}

TEST_F(ListenTest, SeveralAddressesAtOnce) {
  ServerSettings settings;
  const std::string path = folder_.path() / "m.sock";
  settings.listen = {{"127.0.0.1", 0}, {"127.0.0.1", 0}, {{}, 0, path}};
  start(settings);
  ASSERT_EQ(server_->addresses().size(), 3U);
  EXPECT_TRUE(serves());
  const std::string& second = server_->addresses()[1];
  const auto port = static_cast<std::uint16_t>(std::stoi(second.substr(second.rfind(':') + 1)));
  EXPECT_EQ(fetch(port, "/healthz").status, 200);
  EXPECT_EQ(server_->addresses()[2], "unix:" + path);
}

TEST_F(ListenTest, UnixSocketIsServedAndRemoved) {
  const std::filesystem::path path = folder_.path() / "m.sock";
  const ServerSettings settings = listening_on({{}, 0, path});
  start(settings, 100'000);
  Connection connection(path);
  connection.send_get(range_path(0, 200));
  EXPECT_EQ(connection.receive().body, frames(0, 3));
  // One that is listened on is in use; one that is left behind is not.
  EXPECT_FALSE(Server::start(served(open_catalog(folder_.path())), settings).ok());
  EXPECT_TRUE(std::filesystem::exists(path));
  server_->stop();
  EXPECT_FALSE(std::filesystem::exists(path));
  const int left_behind = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.string().copy(address.sun_path, sizeof(address.sun_path) - 1);
  ASSERT_EQ(::bind(left_behind, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  ::close(left_behind);
  start(settings);
  Connection again(path);
  again.send_get("/healthz");
  EXPECT_EQ(again.receive().status, 200);
}

TEST_F(ListenTest, FileThatIsNoSocketIsLeftAlone) {
  const std::filesystem::path path = folder_.path() / "town.map";
  write_town(path);
  const auto server =
      Server::start(served(open_catalog(folder_.path())), listening_on({{}, 0, path}));
  EXPECT_FALSE(server.ok());
  EXPECT_TRUE(std::filesystem::is_regular_file(path));
}

TEST_F(ListenTest, InheritedSocketIsServed) {
  const int inherited = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(::bind(inherited, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  ASSERT_EQ(::listen(inherited, 10), 0);
  ServerSettings settings;
  settings.listen.clear();
  settings.inherited = {inherited};
  start(settings);
  EXPECT_TRUE(serves());
}

TEST_F(ListenTest, InheritedDescriptorThatIsNoSocketIsAnError) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  const auto socket = ListeningSocket::inherited(pipe[0]);
  ASSERT_FALSE(socket.ok());
  EXPECT_THAT(socket.error().line(), HasSubstr("is not a listening stream socket"));
  ::close(pipe[0]);
  ::close(pipe[1]);
}

TEST(ServiceManagerTest, DescriptorsAreThoseOfThisProcess) {
  EXPECT_TRUE(inherited_descriptors().empty());
  ::setenv("LISTEN_FDS", "2", 1);
  ::setenv("LISTEN_PID", std::to_string(::getpid()).c_str(), 1);
  EXPECT_THAT(inherited_descriptors(), ElementsAre(3, 4));
  EXPECT_EQ(std::getenv("LISTEN_FDS"), nullptr);
  ::setenv("LISTEN_FDS", "2", 1);
  ::setenv("LISTEN_PID", "1", 1);
  EXPECT_TRUE(inherited_descriptors().empty());
  EXPECT_EQ(std::getenv("LISTEN_PID"), nullptr);
}

TEST(ServiceManagerTest, IsNotified) {
  EXPECT_TRUE(notify_service_manager("READY=1").ok());  // nobody wants to know
  const TemporaryFolder folder;
  const std::string path = folder.path() / "notify";
  const int manager = ::socket(AF_UNIX, SOCK_DGRAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof(address.sun_path) - 1);
  ASSERT_EQ(::bind(manager, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
  ASSERT_TRUE(notify_service_manager("READY=1").ok());
  std::array<char, 100> told{};
  EXPECT_EQ(::recv(manager, told.data(), told.size(), 0), 7);
  EXPECT_STREQ(told.data(), "READY=1");
  ::close(manager);
  EXPECT_FALSE(notify_service_manager("STOPPING=1").ok());
  ::unsetenv("NOTIFY_SOCKET");
}

SocketAddress ipv6(const std::array<std::uint8_t, 16>& bytes) {
  SocketAddress address;
  auto& inner = reinterpret_cast<sockaddr_in6&>(address.storage);
  inner.sin6_family = AF_INET6;
  std::copy(bytes.begin(), bytes.end(), std::begin(inner.sin6_addr.s6_addr));
  return address;
}

TEST(PeerTest, NetworkOfIpv6IsOneClient) {
  const Peer one = Peer::of(ipv6({0x20, 1, 0xd, 0xb8, 0, 0, 0, 1, 1, 2, 3, 4, 5, 6, 7, 8}));
  const Peer two = Peer::of(ipv6({0x20, 1, 0xd, 0xb8, 0, 0, 0, 1, 9, 9}));
  const Peer other = Peer::of(ipv6({0x20, 1, 0xd, 0xb8, 0, 0, 0, 2, 9, 9}));
  EXPECT_EQ(one.host, "2001:db8:0:1:102:304:506:708");
  EXPECT_EQ(one.key, two.key);
  EXPECT_NE(one.key, other.key);
  // An IPv4 address that is written as IPv6 is that address.
  const Peer mapped = Peer::of(ipv6({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 127, 0, 0, 1}));
  SocketAddress plain;
  reinterpret_cast<sockaddr_in&>(plain.storage) = {AF_INET, 0, {htonl(INADDR_LOOPBACK)}, {}};
  EXPECT_EQ(mapped.key, Peer::of(plain).key);
}

TEST(AdmissionTest, CountsInAllAndByAddress) {
  Admission admission(2, 1);
  const Peer first{"a", {1}, true};
  const Peer second{"b", {2}, true};
  const Peer proxy{"unix", {}, false};
  {
    const auto one = admission.enter(first);
    EXPECT_EQ(one.verdict(), Admission::Verdict::serve);
    const auto same = admission.enter(first);
    EXPECT_EQ(same.verdict(), Admission::Verdict::reject);
    EXPECT_EQ(admission.enter(first).verdict(), Admission::Verdict::drop);
    const auto two = admission.enter(proxy);
    EXPECT_EQ(two.verdict(), Admission::Verdict::serve);
    auto three = admission.enter(second);
    EXPECT_EQ(three.verdict(), Admission::Verdict::replace);
    EXPECT_EQ(admission.count(), 4U);
    EXPECT_TRUE(admission.overfull());
    three.reject();  // no other one is idle, and `same` is being rejected
    EXPECT_EQ(three.verdict(), Admission::Verdict::drop);
    EXPECT_EQ(admission.count(), 3U);
    EXPECT_FALSE(admission.overfull());
  }
  EXPECT_EQ(admission.count(), 0U);
  EXPECT_EQ(admission.enter(first).verdict(), Admission::Verdict::serve);
}

TEST(DescriptorLimitTest, LeavesDescriptorsForMaps) {
  EXPECT_EQ(connections_within(0), 1U);
  EXPECT_GE(connections_within(64), 1U);
  EXPECT_LT(connections_within(1024), 768U);  // some are open
  EXPECT_EQ(connections_within(1'000'000'000), 65536U);
}

}  // namespace
}  // namespace milepost::server
