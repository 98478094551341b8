#include "schema/base/json.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace milepost {
namespace {

constexpr std::size_t kMaxReasonBytes = 200;

Error too_large(const std::string& what) {
  return {ErrorCode::corrupt, "", "it " + what, "give a smaller document"};
}

// The parser's explanation without the library's own error number, on one line. It quotes the last
// token, which may hold any bytes.
std::string reason_of(const nlohmann::json::exception& error) {
  std::string text = error.what();
  const std::size_t end = text.find("] ");
  if (end != std::string::npos) text.erase(0, end + 2);
  if (text.size() > kMaxReasonBytes) text = text.substr(0, kMaxReasonBytes) + "...";
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
  }
  return text;
}

// Builds the value from the parser's events (nlohmann's SAX interface), and stops parsing at the
// first exceeded limit. The parser itself does not recurse.
template <class Json>
class BoundedBuilder : public nlohmann::json_sax<Json> {
 public:
  explicit BoundedBuilder(const JsonLimits& limits) : limits_(limits) {}

  bool null() override { return add(nullptr) != nullptr; }
  bool boolean(bool value) override { return add(value) != nullptr; }
  bool number_integer(typename Json::number_integer_t value) override {
    return add(value) != nullptr;
  }
  bool number_unsigned(typename Json::number_unsigned_t value) override {
    return add(value) != nullptr;
  }
  bool number_float(typename Json::number_float_t value, const std::string& /*text*/) override {
    return add(value) != nullptr;
  }
  bool string(std::string& value) override { return add(std::move(value)) != nullptr; }
  bool binary(typename Json::binary_t& value) override { return add(std::move(value)) != nullptr; }

  bool start_object(std::size_t /*unknown*/) override { return open(Json::object()); }
  bool start_array(std::size_t /*unknown*/) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(std::string& name) override {
    if (open_.back()->size() >= limits_.members) {
      error_ =
          too_large("has an object of more than " + std::to_string(limits_.members) + " members");
      return false;
    }
    member_ = std::move(name);
    return true;
  }

  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const nlohmann::json::exception& error) override {
    error_ = Error{ErrorCode::corrupt, "byte " + std::to_string(position),
                   "this is not JSON (" + reason_of(error) + ")", "correct the JSON"};
    return false;
  }

  Result<Json> finish() && {
    if (error_) return std::move(*error_);
    return std::move(root_);
  }

 private:
  // Inserts a value at the current position. Null if the limit is exceeded.
  Json* add(Json value) {
    if (++values_ > limits_.values) {
      error_ = too_large("holds more than " + std::to_string(limits_.values) + " values");
      return nullptr;
    }
    if (open_.empty()) return &(root_ = std::move(value));
    if (open_.back()->is_array()) return &open_.back()->emplace_back(std::move(value));
    return &((*open_.back())[member_] = std::move(value));
  }

  bool open(Json container) {
    if (open_.size() >= limits_.depth) {
      error_ = too_large("is nested more than " + std::to_string(limits_.depth) + " deep");
      return false;
    }
    Json* const added = add(std::move(container));
    if (added != nullptr) open_.push_back(added);
    return added != nullptr;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  const JsonLimits& limits_;
  Json root_;
  std::vector<Json*> open_;  // the open containers, from the root inwards
  std::string member_;       // the name of the next value in an object
  std::size_t values_ = 0;
  std::optional<Error> error_;
};

template <class Json>
Result<Json> read(std::string_view text, const JsonLimits& limits) {
  if (text.size() > limits.bytes) {
    return too_large("is longer than " + std::to_string(limits.bytes) + " bytes");
  }
  BoundedBuilder<Json> builder(limits);
  Json::sax_parse(text, &builder);
  return std::move(builder).finish();
}

}  // namespace

Result<nlohmann::json> read_json(std::string_view text, const JsonLimits& limits) {
  return read<nlohmann::json>(text, limits);
}

Result<nlohmann::ordered_json> read_ordered_json(std::string_view text, const JsonLimits& limits) {
  return read<nlohmann::ordered_json>(text, limits);
}

}  // namespace milepost
