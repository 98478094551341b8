// Records of a bag of ROS 1, format 2.0: the length of a header, the header, the length of the
// data, the data. A header is a list of fields, each "NAME=VALUE" with its length before it.
// Lengths have 32 bits; numbers are little endian.
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "schema/base/bytes.h"
#include "schema/base/result.h"

namespace milepost::ros {

enum class Ros1Op : std::uint8_t {
  message = 2,
  bag_header = 3,
  index = 4,
  chunk = 5,
  chunk_info = 6,
  connection = 7
};

// Bytes that records are read from.
class ByteSource {
 public:
  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;

  virtual std::uint64_t size() const = 0;
  // `count` bytes, until the next call. Errors: corrupt (they are not all there), io; `where` is
  // left to the caller.
  Result<ByteView> bytes(std::uint64_t at, std::uint64_t count);

 private:
  // REQUIRES: the bytes are there.
  virtual Result<ByteView> read(std::uint64_t at, std::size_t count) = 0;
};

class MemoryBytes : public ByteSource {
 public:
  // REQUIRES: `bytes` outlives it.
  explicit MemoryBytes(ByteView bytes) : bytes_(bytes) {}
  std::uint64_t size() const override { return bytes_.size(); }

 private:
  Result<ByteView> read(std::uint64_t at, std::size_t count) override {
    return bytes_.subspan(at, count);
  }

  ByteView bytes_;
};

class FileBytes : public ByteSource {
 public:
  // REQUIRES: `file` is open and has `size` bytes.
  FileBytes(std::ifstream file, std::uint64_t size) : file_(std::move(file)), size_(size) {}
  std::uint64_t size() const override { return size_; }

 private:
  Result<ByteView> read(std::uint64_t at, std::size_t count) override;

  std::ifstream file_;
  std::uint64_t size_;
  Bytes buffer_;
};

// A header's fields, the numbers and texts of some records' data, too.
class Ros1Fields {
 public:
  // Errors: corrupt; `where` is left to the caller.
  static Result<Ros1Fields> parse(ByteView bytes);

  std::optional<std::string_view> text(std::string_view name) const;
  // Of as many bytes as the field has, up to 8. Errors: corrupt (no such field).
  Result<std::uint64_t> number(std::string_view name) const;

 private:
  std::vector<std::pair<std::string, std::string>> fields_;
};

struct Ros1Record {
  Ros1Op op = Ros1Op::message;
  Ros1Fields header;
  std::uint64_t data_at = 0;
  std::uint32_t data_bytes = 0;

  std::uint64_t end() const { return data_at + data_bytes; }
};

// The record that begins at a byte; its data is all there. Errors: corrupt, io; `where` is left to
// the caller.
Result<Ros1Record> ros1_record_at(ByteSource& source, std::uint64_t at);

// REQUIRES: at most 8 bytes.
std::uint64_t little_endian(ByteView bytes);

}  // namespace milepost::ros
