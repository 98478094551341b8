#include "server/catalog/signatures.h"

#include "server/catalog/signature_file.h"

namespace milepost::server {

Result<std::string> Signatures::of(const SignedPlace& place) {
  const std::pair key(place.map, place.build);
  const Result<StoredSignature> beside = read_signature(place.file);
  if (beside && beside->about.map == place.map && beside->about.build == place.build) {
    const std::lock_guard lock(mutex_);
    return seen_[key] = beside->text;
  }
  const bool is_replaced = beside && beside->about.map == place.map;
  Result<std::string> none = read_signature_of(place.file, place.map, place.build);
  if (place.is_current && !is_replaced) return none;
  Result<std::string> kept = read_signature_of(place.kept_file, place.map, place.build);
  if (kept) return kept;
  const std::lock_guard lock(mutex_);
  const auto seen = seen_.find(key);
  return seen == seen_.end() ? none : seen->second;
}

void Signatures::see(const std::string& map, const std::string& build,
                     const std::filesystem::path& file) {
  const Result<std::string> signature = read_signature_of(file, map, build);
  const std::lock_guard lock(mutex_);
  if (signature) seen_[{map, build}] = *signature;
}

}  // namespace milepost::server
