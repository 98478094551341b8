#include "client/fetch/signed_builds.h"

#include <algorithm>
#include <utility>

namespace milepost {
namespace {

constexpr const char* kHint =
    "use the operator's map, sign it, or give the key that it is signed with";

std::string place_of(const MapVersion& version) {
  return "map '" + version.map + "', build " + version.build;
}

Error refused(const std::string& where, const std::string& what) {
  return {ErrorCode::corrupt, where, what, kHint};
}

}  // namespace

Status SignedBuilds::check(const MapVersion& version, const std::string& url,
                           const RetryPolicy& retry, const Stopped& stopped) {
  if (check_cached(version)) return ok_status();
  return with_retries(retry, stopped, [&] { return fetch(version, url, stopped); });
}

Status SignedBuilds::check_cached(const MapVersion& version) {
  if (keys_.empty()) return ok_status();
  {
    const std::lock_guard lock(mutex_);
    if (accepted_.contains(version)) return ok_status();
    if (!has_loaded_) load_cached();
  }
  const std::string where = place_of(version);
  const auto text = cache_.find(CacheKey::signature(version.map, version.build));
  if (!text) return refused(where, "the cache has no signature of it");
  const Result<std::int64_t> signed_s = time_of(as_text(*text), version, where);
  return signed_s ? accept(version, *signed_s, where) : Status(signed_s.error());
}

// The cache remembers which builds earlier runs have accepted. REQUIRES: `mutex_` is held.
void SignedBuilds::load_cached() {
  has_loaded_ = true;
  for (const CachedDocument& cached : cache_.signatures()) {
    const auto signed_s = time_of(cached.content, {cached.key.map, cached.key.build}, "");
    if (!signed_s) continue;
    std::int64_t& newest_s = newest_s_[cached.key.map];
    newest_s = std::max(newest_s, *signed_s);
  }
}

// When the build was signed. Errors: corrupt, also if it was not, or by another key.
Result<std::int64_t> SignedBuilds::time_of(std::string_view text, const MapVersion& version,
                                           const std::string& where) const {
  const Result<Signature> signature = signature_from(text);
  if (!signature) return refused(where, signature.error().what);
  const SignedBuild& about = signature->about;
  if (about.map != version.map) {
    return refused(where, "the signature is one of map '" + about.map + "'");
  }
  if (about.build != version.build) {
    return refused(where, "the signature is one of build " + about.build);
  }
  const bool is_ours =
      std::ranges::any_of(keys_, [&](const PublicKey& key) { return signature->is_by(key); });
  if (is_ours) return about.signed_s;
  return refused(where,
                 "the signature is not by one of the given keys; it names key " + signature->key);
}

Status SignedBuilds::accept(const MapVersion& version, std::int64_t signed_s,
                            const std::string& where) {
  const std::lock_guard lock(mutex_);
  std::int64_t& newest_s = newest_s_[version.map];
  if (signed_s < newest_s) {
    return Error{ErrorCode::gone, where, "a build that was signed later has been accepted before",
                 "sign the map again if it is meant to replace that one"};
  }
  newest_s = signed_s;
  accepted_.insert(version);
  return ok_status();
}

Attempt SignedBuilds::fetch(const MapVersion& version, const std::string& url,
                            const Stopped& stopped) {
  Status refusal;
  for (const Caches caches : {Caches::allowed, Caches::bypassed}) {
    std::string text;
    const HttpAnswer answer = requests_.get(
        url, kMaxSignatureBytes, caches,
        [&text](ByteView piece) {
          text += as_text(piece);
          return ok_status();
        },
        stopped);
    if (!answer.status.ok()) {
      const Error& error = answer.status.error();
      if (error.code != ErrorCode::not_found && error.code != ErrorCode::corrupt) {
        return {answer.status, answer.retry_after_s};
      }
      refusal = refused(url, error.code == ErrorCode::not_found ? "the build is not signed"
                                                                : "this is no signature");
      continue;
    }
    const Result<std::int64_t> signed_s = time_of(text, version, url);
    if (signed_s) {
      const Status accepted = accept(version, *signed_s, url);
      if (accepted) cache_.store(CacheKey::signature(version.map, version.build), as_bytes(text));
      return {accepted};
    }
    refusal = signed_s.error();
  }
  return {refusal};
}

}  // namespace milepost
