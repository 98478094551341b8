// The builds that one of the operator's keys has signed; with keys, no others are used.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "client/cache/tile_cache.h"
#include "client/fetch/map_source.h"
#include "client/fetch/server_requests.h"
#include "schema/document/signature.h"

namespace milepost {

// Safe to use from several threads at once.
class SignedBuilds {
 public:
  // Without keys every build is accepted. REQUIRES: both references outlive it.
  SignedBuilds(std::vector<PublicKey> keys, ServerRequests& requests, TileCache& cache)
      : keys_(std::move(keys)), requests_(requests), cache_(cache) {}

  // Accepts the build, or says why not. Its signature is read from the cache, then requested from
  // `url`, past caches too, and stored if it is good. A build that was signed before one that was
  // accepted of the same map is refused, except by a source that had accepted it earlier. Errors:
  // those of HttpAnswer; corrupt (no signature, or none by a key for this map and build); gone (a
  // later build was accepted).
  Status check(const MapVersion& version, const std::string& url, const RetryPolicy& retry,
               const Stopped& stopped);
  // The same with what the cache knows.
  Status check_cached(const MapVersion& version);

 private:
  void load_cached();
  Result<std::int64_t> time_of(std::string_view text, const MapVersion& version,
                               const std::string& where) const;
  Status accept(const MapVersion& version, std::int64_t signed_s, const std::string& where);
  Attempt fetch(const MapVersion& version, const std::string& url, const Stopped& stopped);

  const std::vector<PublicKey> keys_;
  ServerRequests& requests_;
  TileCache& cache_;

  std::mutex mutex_;  // guards all below
  bool has_loaded_ = false;
  std::set<MapVersion> accepted_;
  std::map<std::string, std::int64_t> newest_s_;  // by map: when the latest of them was signed
};

}  // namespace milepost
