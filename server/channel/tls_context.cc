#include "server/channel/tls_context.h"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>

#include <ctime>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>

namespace milepost::server {
namespace {

constexpr std::string_view kProtocols("\x08http/1.1", 9);  // as ALPN writes a list

// The reason of OpenSSL's last error, and forgets all of them.
std::string last_reason() {
  const char* reason = ERR_reason_error_string(ERR_peek_last_error());
  std::string text = reason == nullptr ? "unknown reason" : reason;
  ERR_clear_error();
  return text;
}

Error wrong_file(const std::filesystem::path& file, const std::string& what,
                 const std::string& hint) {
  return {ErrorCode::invalid_input, file.string(), what + " (" + last_reason() + ")", hint};
}

Status check_readable(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (stream && stream.peek() != std::ifstream::traits_type::eof()) return ok_status();
  return Error{ErrorCode::io, file.string(), "cannot be read, or is empty",
               "check the path, and that the server's user may read the file"};
}

// A key with a passphrase is refused: nobody is there to type it.
int no_passphrase(char* /*buffer*/, int /*bytes*/, int /*writing*/, void* /*user*/) { return 0; }

int select_protocol(SSL* /*session*/, const unsigned char** chosen, unsigned char* length,
                    const unsigned char* offered, unsigned int offered_length, void* /*user*/) {
  unsigned char* found = nullptr;
  const auto* ours = reinterpret_cast<const unsigned char*>(kProtocols.data());
  const int selected = SSL_select_next_proto(
      &found, length, ours, static_cast<unsigned>(kProtocols.size()), offered, offered_length);
  *chosen = found;
  return selected == OPENSSL_NPN_NEGOTIATED ? SSL_TLSEXT_ERR_OK : SSL_TLSEXT_ERR_ALERT_FATAL;
}

void configure(SSL_CTX* context) {
  SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION);
  SSL_CTX_set_options(context, SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION |
                                   SSL_OP_CIPHER_SERVER_PREFERENCE | SSL_OP_PRIORITIZE_CHACHA);
  // Connections that wait hold no buffers; pieces may have moved when they are sent again.
  SSL_CTX_set_mode(context, SSL_MODE_RELEASE_BUFFERS | SSL_MODE_ENABLE_PARTIAL_WRITE |
                                SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  SSL_CTX_set_session_cache_mode(context, SSL_SESS_CACHE_OFF);  // tickets resume sessions
  SSL_CTX_set_num_tickets(context, 1);
  SSL_CTX_set_default_passwd_cb(context, no_passphrase);
  SSL_CTX_set_alpn_select_cb(context, select_protocol, nullptr);
}

std::chrono::sys_seconds expiry_of(SSL_CTX* context) {
  std::tm utc{};
  if (ASN1_TIME_to_tm(X509_get0_notAfter(SSL_CTX_get0_certificate(context)), &utc) != 1) return {};
  return std::chrono::sys_seconds(std::chrono::seconds(timegm(&utc)));
}

}  // namespace

Result<std::shared_ptr<const TlsContext>> TlsContext::load(const TlsFiles& files) {
  for (const auto& file : {files.certificate, files.key}) {
    const Status readable = check_readable(file);
    if (!readable) return readable.error();
  }
  const Native context(SSL_CTX_new(TLS_server_method()), SSL_CTX_free);
  if (!context) return wrong_file(files.certificate, "TLS cannot be set up", "free some memory");
  configure(context.get());
  if (SSL_CTX_use_certificate_chain_file(context.get(), files.certificate.c_str()) != 1) {
    return wrong_file(files.certificate, "is no certificate in PEM form",
                      "give the server's certificate, followed by those that signed it");
  }
  if (SSL_CTX_use_PrivateKey_file(context.get(), files.key.c_str(), SSL_FILETYPE_PEM) != 1) {
    return wrong_file(files.key, "is no key for the certificate",
                      "give the certificate's private key in PEM form, without a passphrase");
  }
  return std::shared_ptr<const TlsContext>(new TlsContext(context, expiry_of(context.get())));
}

TlsContext::TlsContext(Native context, std::chrono::sys_seconds expires)
    : context_(std::move(context)), expires_(expires) {}

}  // namespace milepost::server
