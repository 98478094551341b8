#include "server/setup.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <utility>

namespace milepost::server {
namespace {

// What `load` reads from the files, now and whenever they change.
template <class Value>
Result<std::shared_ptr<const Current<Value>>> followed(
    Setup& setup, const std::vector<std::filesystem::path>& files,
    const std::function<Result<std::shared_ptr<const Value>>()>& load) {
  // Followed before they are read: a change between the two is seen at the first look.
  const auto current = std::make_shared<std::shared_ptr<Current<Value>>>();
  setup.followed.push_back(std::make_unique<FollowedFiles>(files, [load, current]() -> Status {
    Result<std::shared_ptr<const Value>> next = load();
    if (!next) return next.error();
    (*current)->replace(std::move(*next));
    return ok_status();
  }));
  Result<std::shared_ptr<const Value>> first = load();
  if (!first) return first.error();
  *current = std::make_shared<Current<Value>>(std::move(*first));
  return std::shared_ptr<const Current<Value>>(*current);
}

Result<std::shared_ptr<const TlsContext>> load_tls(const TlsFiles& files) {
  auto context = TlsContext::load(files);
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  if (context && (*context)->expires() <= now) {
    spdlog::warn("{}: the certificate has expired, and clients refuse it; renew it",
                 files.certificate.string());
  }
  return context;
}

}  // namespace

Result<Setup> set_up(const Options& options) {
  Result<Viewer> viewer = Viewer::with(options.viewer);
  if (!viewer) return viewer.error();
  Setup setup;
  setup.settings = options.server;
  setup.settings.viewer = std::make_shared<const Viewer>(std::move(*viewer));
  if (!options.tls.certificate.empty()) {
    const auto tls = followed<TlsContext>(setup, {options.tls.certificate, options.tls.key},
                                          [files = options.tls] { return load_tls(files); });
    if (!tls) return tls.error();
    setup.settings.tls = *tls;
  }
  if (!options.tokens.empty()) {
    const auto tokens = followed<Tokens>(setup, {options.tokens},
                                         [file = options.tokens] { return Tokens::read(file); });
    if (!tokens) return tokens.error();
    setup.settings.tokens = *tokens;
  }
  return setup;
}

}  // namespace milepost::server
