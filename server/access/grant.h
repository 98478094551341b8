// What a request may ask for.
#pragma once

#include <chrono>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace milepost::server {

// What the server keeps of a token, which is not the token.
struct TokenEntry {
  std::string id;      // the part of the token by which it is found
  std::string name;    // whose it is, for the log and for taking it back
  std::string sha256;  // of the whole token, in hexadecimal digits
  bool all_maps = false;
  std::set<std::string, std::less<>> maps;  // if not all
  std::chrono::sys_seconds expires = {};    // the epoch: never
};

class Grant {
 public:
  // Where no tokens are asked for.
  static Grant everything() { return Grant(Kind::everything, nullptr); }
  static Grant by(std::shared_ptr<const TokenEntry> entry) {
    const Kind kind = entry->all_maps ? Kind::everything : Kind::maps;
    return Grant(kind, std::move(entry));
  }
  // Without a token; with one that is not known, or is no token; with one that has expired.
  static Grant without_token() { return Grant(Kind::no_token, nullptr); }
  static Grant of_unknown_token() { return Grant(Kind::unknown_token, nullptr); }
  static Grant of_expired_token() { return Grant(Kind::expired_token, nullptr); }

  // All maps, and what the server says of itself.
  bool is_for_everything() const { return kind_ == Kind::everything; }
  bool is_for(std::string_view map) const {
    return is_for_everything() || (kind_ == Kind::maps && entry_->maps.contains(map));
  }
  // There is a valid token, or none is asked for.
  bool is_valid() const { return kind_ == Kind::everything || kind_ == Kind::maps; }
  bool is_of_bad_token() const { return !is_valid() && kind_ != Kind::no_token; }
  bool is_of_expired_token() const { return kind_ == Kind::expired_token; }
  // Of the valid token; null without.
  const TokenEntry* token() const { return entry_.get(); }

 private:
  enum class Kind { everything, maps, no_token, unknown_token, expired_token };
  Grant(Kind kind, std::shared_ptr<const TokenEntry> entry)
      : kind_(kind), entry_(std::move(entry)) {}

  Kind kind_;
  std::shared_ptr<const TokenEntry> entry_;
};

}  // namespace milepost::server
