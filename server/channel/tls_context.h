// The certificate with which the server proves who it is, and how it speaks TLS.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>

#include "schema/base/result.h"
#include "server/current/current.h"

struct ssl_ctx_st;  // OpenSSL's SSL_CTX

namespace milepost::server {

struct TlsFiles {
  std::filesystem::path certificate;  // PEM: the server's, then those between it and its root
  std::filesystem::path key;          // PEM, without a passphrase
};

// TLS 1.2 and 1.3, HTTP/1.1 by ALPN (RFC 7301). Safe to use from several threads at once.
class TlsContext {
 public:
  // Errors: io (a file cannot be read), invalid_input (it is no certificate or key, the two do not
  // belong together).
  static Result<std::shared_ptr<const TlsContext>> load(const TlsFiles& files);

  // When the certificate expires.
  std::chrono::sys_seconds expires() const { return expires_; }
  ssl_ctx_st* native() const { return context_.get(); }

 private:
  using Native = std::shared_ptr<ssl_ctx_st>;
  TlsContext(Native context, std::chrono::sys_seconds expires);

  Native context_;
  std::chrono::sys_seconds expires_;
};

// Connections that are open keep the one that they began with.
using CurrentTls = Current<TlsContext>;

}  // namespace milepost::server
