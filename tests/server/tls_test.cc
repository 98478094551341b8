// The server over TLS, with OpenSSL as the client.
#include <gmock/gmock.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <cstdio>
#include <thread>
#include <vector>

#include "server/channel/tls_context.h"
#include "tests/server/server_fixture.h"

namespace milepost::server {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// A new key, and a certificate for 127.0.0.1 that it signs itself, valid for so long.
TlsFiles write_certificate(const std::filesystem::path& folder, const std::string& name,
                           std::chrono::seconds valid = std::chrono::hours(1)) {
  const TlsFiles files = {folder / (name + ".pem"), folder / (name + ".key")};
  EVP_PKEY* key = EVP_EC_gen("P-256");
  X509* certificate = X509_new();
  ASN1_INTEGER_set(X509_get_serialNumber(certificate), 1);
  X509_gmtime_adj(X509_getm_notBefore(certificate), -7200);
  X509_gmtime_adj(X509_getm_notAfter(certificate), valid.count());
  X509_set_pubkey(certificate, key);
  X509_NAME* subject = X509_get_subject_name(certificate);
  X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC,
                             reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0);
  X509_set_issuer_name(certificate, subject);
  X509_sign(certificate, key, EVP_sha256());
  FILE* file = std::fopen(files.certificate.c_str(), "w");
  PEM_write_X509(file, certificate);
  std::fclose(file);
  file = std::fopen(files.key.c_str(), "w");
  PEM_write_PrivateKey(file, key, nullptr, nullptr, 0, nullptr, nullptr);
  std::fclose(file);
  X509_free(certificate);
  EVP_PKEY_free(key);
  return files;
}

// A connection through TLS that accepts any certificate.
class TlsClient {
 public:
  explicit TlsClient(std::uint16_t port, int highest = TLS1_3_VERSION,
                     std::string_view protocols = "\x08http/1.1")
      : connection_(port) {
    context_ = SSL_CTX_new(TLS_client_method());
    SSL_CTX_set_max_proto_version(context_, highest);
    SSL_CTX_set_alpn_protos(context_, reinterpret_cast<const unsigned char*>(protocols.data()),
                            static_cast<unsigned>(protocols.size()));
    session_ = SSL_new(context_);
    SSL_set_fd(session_, connection_.descriptor());
    ERR_clear_error();
    connected_ = SSL_connect(session_) == 1;
  }
  ~TlsClient() {
    SSL_free(session_);
    SSL_CTX_free(context_);
  }
  TlsClient(const TlsClient&) = delete;
  TlsClient& operator=(const TlsClient&) = delete;

  bool connected() const { return connected_; }
  int version() const { return SSL_version(session_); }
  std::string subject() const {
    X509* certificate = SSL_get0_peer_certificate(session_);
    char name[100] = "";
    X509_NAME_get_text_by_NID(X509_get_subject_name(certificate), NID_commonName, name,
                              sizeof(name));
    return name;
  }
  std::string protocol() const {
    const unsigned char* name = nullptr;
    unsigned length = 0;
    SSL_get0_alpn_selected(session_, &name, &length);
    return {reinterpret_cast<const char*>(name), length};
  }
  bool send(std::string_view bytes) {
    return SSL_write(session_, bytes.data(), static_cast<int>(bytes.size())) ==
           static_cast<int>(bytes.size());
  }
  void send_get(const std::string& target, const std::string& headers = "") {
    send("GET " + target + " HTTP/1.1\r\nHost: h\r\n" + headers + "\r\n");
  }
  // All bytes until the server ends the connection.
  std::string rest() {
    std::string all;
    char bytes[16384];
    while (true) {
      const int count = SSL_read(session_, bytes, sizeof(bytes));
      if (count <= 0) return all;
      all.append(bytes, static_cast<std::size_t>(count));
    }
  }
  // The server has ended the session as TLS has it, so that nothing was cut off.
  bool ended_properly() const { return (SSL_get_shutdown(session_) & SSL_RECEIVED_SHUTDOWN) != 0; }
  bool renew_keys() { return SSL_key_update(session_, SSL_KEY_UPDATE_REQUESTED) == 1; }
  SSL* session() { return session_; }

 private:
  Connection connection_;
  SSL_CTX* context_ = nullptr;
  SSL* session_ = nullptr;
  bool connected_ = false;
};

std::string body_of(const std::string& reply) {
  const std::size_t end = reply.find("\r\n\r\n");
  return end == std::string::npos ? "" : reply.substr(end + 4);
}

class TlsTest : public ServerTest {
 protected:
  void start_tls(ServerSettings settings = {}, std::size_t frame_bytes = 1000) {
    files_ = write_certificate(certificates_.path(), "first");
    current_ = std::make_shared<CurrentTls>(*TlsContext::load(files_));
    settings.tls = current_;
    start(settings, frame_bytes);
  }
  std::string last_get(const std::string& target) const {
    TlsClient client(port_);
    client.send_get(target, "Connection: close\r\n");
    return client.rest();
  }

  TemporaryFolder certificates_;
  TlsFiles files_;
  std::shared_ptr<CurrentTls> current_;
};

TEST_F(TlsTest, AnswersAreTheSameAsWithoutIt) {
  start_tls();
  for (const int highest : {TLS1_2_VERSION, TLS1_3_VERSION}) {
    TlsClient client(port_, highest);
    ASSERT_TRUE(client.connected());
    EXPECT_EQ(client.version(), highest);
    EXPECT_EQ(client.protocol(), "http/1.1");
    EXPECT_EQ(client.subject(), "first");
    client.send_get(segment_path() + "/tiles/tracklets/0");
    client.send_get(range_path(0, 300), "Connection: close\r\n");
    const std::string replies = client.rest();
    EXPECT_THAT(replies, StartsWith("HTTP/1.1 200 OK\r\n"));
    EXPECT_THAT(replies, HasSubstr(frames(0, 0) + "HTTP/1.1 200 OK\r\n"));
    EXPECT_TRUE(replies.ends_with(frames(0, 3)));
    EXPECT_TRUE(client.ended_properly());
  }
}

TEST_F(TlsTest, LongBodiesArriveWhole) {
  start_tls({}, 3'000'001);  // many records, and more than the socket's buffer
  EXPECT_EQ(body_of(last_get(range_path(0, 300))), frames(0, 3));
}

TEST_F(TlsTest, ManyRequestsInOneRecordAndOneInMany) {
  start_tls();
  TlsClient client(port_);
  std::string requests;
  for (int i = 0; i < 400; ++i) requests += "GET /healthz HTTP/1.1\r\nHost: h\r\n\r\n";
  ASSERT_TRUE(client.send(requests));
  for (const char c : std::string("GET /v1/maps HTTP/1.1\r\nHost: h\r\nConnection: close\r\n\r\n"))
    ASSERT_TRUE(client.send({&c, 1}));
  const std::string replies = client.rest();
  std::size_t count = 0;
  for (std::size_t at = 0; (at = replies.find("\r\n\r\nok\n", at)) != std::string::npos; ++at)
    ++count;
  EXPECT_EQ(count, 400U);
  EXPECT_THAT(replies, HasSubstr("\"town\""));
}

TEST_F(TlsTest, NewKeysInTheMiddle) {
  start_tls({}, 2'000'000);
  TlsClient client(port_);
  client.send_get(range_path(0, 300));
  ASSERT_TRUE(client.renew_keys());
  client.send_get(range_path(0, 0), "Connection: close\r\n");
  const std::string replies = client.rest();
  EXPECT_TRUE(replies.ends_with(frames(0, 0)));
  EXPECT_THAT(replies, HasSubstr(frames(0, 3)));
}

TEST_F(TlsTest, ConnectionsBeginWithTheCurrentCertificate) {
  start_tls();
  TlsClient before(port_);
  EXPECT_EQ(before.subject(), "first");
  current_->replace(*TlsContext::load(write_certificate(certificates_.path(), "second")));
  TlsClient after(port_);
  EXPECT_EQ(after.subject(), "second");
  before.send_get("/healthz", "Connection: close\r\n");
  EXPECT_THAT(before.rest(), HasSubstr("ok\n"));
}

TEST_F(TlsTest, WhatIsNoTlsEnds) {
  start_tls();
  Connection plain(port_);
  plain.send("GET /healthz HTTP/1.1\r\nHost: h\r\n\r\n");
  EXPECT_EQ(plain.receive().status, 0);
  Connection noise(port_);
  noise.send(std::string(1000, '\x16'));
  EXPECT_EQ(noise.receive().status, 0);
  TlsClient old(port_, TLS1_1_VERSION);
  EXPECT_FALSE(old.connected());
  TlsClient other(port_, TLS1_3_VERSION, "\x02h2");
  EXPECT_FALSE(other.connected());
  EXPECT_THAT(last_get("/metrics"), HasSubstr("milepost_tls_handshakes_failed_total 4"));
}

TEST_F(TlsTest, SilentOnesAreClosedInTimeAndMakeRoom) {
  ServerSettings settings;
  settings.threads = 1;
  settings.limits.connections = 2;
  settings.limits.per_address = 10;
  settings.limits.request = 300ms;
  start_tls(settings);
  Connection half(port_);
  half.send(std::string("\x16\x03\x01\x02", 4));  // the start of a hello
  EXPECT_TRUE(half.closed());
  Connection silent(port_);
  Connection silent_too(port_);
  EXPECT_THAT(last_get("/healthz"), HasSubstr("ok\n"));
  EXPECT_TRUE(silent.closed());
}

TEST_F(TlsTest, OneTooManyIsToldSoThroughTls) {
  ServerSettings settings;
  settings.threads = 1;
  settings.limits.connections = 1;
  settings.limits.per_address = 1;
  start_tls(settings);
  TlsClient busy(port_);
  busy.send("GET /healthz HTTP/1.1\r\nHo");
  EXPECT_THAT(last_get("/healthz"), StartsWith("HTTP/1.1 503 "));
}

TEST_F(TlsTest, PlainAddressesAreWithout) {
  ServerSettings settings;
  settings.listen = {
      {}, {"127.0.0.1", 0, {}, true}, {{}, 0, certificates_.path() / "socket", true}};
  start_tls(settings);
  EXPECT_THAT(last_get("/healthz"), HasSubstr("ok\n"));
  const std::string& plain = server_->addresses().at(1);
  const auto port = static_cast<std::uint16_t>(std::stoi(plain.substr(plain.rfind(':') + 1)));
  EXPECT_EQ(fetch(port, "/healthz").body, "ok\n");
  Connection local(certificates_.path() / "socket");
  local.send_get("/healthz");
  EXPECT_EQ(local.receive().body, "ok\n");
}

TEST_F(TlsTest, AStopAnswersWhatWasAskedFor) {
  ServerSettings settings;
  settings.limits.last_request = 100ms;
  start_tls(settings, 4'000'000);
  TlsClient idle(port_);
  TlsClient busy(port_);
  busy.send_get(range_path(0, 300));
  char first = 0;
  ASSERT_EQ(SSL_read(busy.session(), &first, 1), 1);
  std::thread stop([this] { server_->stop(); });
  EXPECT_EQ(body_of(first + busy.rest()), frames(0, 3));
  EXPECT_EQ(idle.rest(), "");
  stop.join();
}

TEST_F(TlsTest, WhatIsWrongWithTheFilesIsNamed) {
  const auto& folder = certificates_.path();
  const TlsFiles one = write_certificate(folder, "one");
  const TlsFiles two = write_certificate(folder, "two");
  const auto fault = [](const TlsFiles& files) {
    const auto context = TlsContext::load(files);
    return context ? std::string() : context.error().line();
  };
  EXPECT_EQ(fault(one), "");
  EXPECT_THAT(
      fault({one.certificate, two.key}),
      StartsWith(two.key.string() + ": is no key for the certificate (key values mismatch)"));
  EXPECT_THAT(fault({one.key, one.key}), StartsWith(one.key.string() + ": is no certificate"));
  EXPECT_THAT(fault({one.certificate, one.certificate}), HasSubstr("is no key"));
  EXPECT_THAT(fault({folder / "absent", one.key}), HasSubstr("absent: cannot be read"));
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  EXPECT_LT(std::chrono::abs((*TlsContext::load(one))->expires() - now - 1h), 1min);
}

}  // namespace
}  // namespace milepost::server
