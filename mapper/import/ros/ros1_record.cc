#include "mapper/import/ros/ros1_record.h"

#include <algorithm>

namespace milepost::ros {
namespace {

constexpr std::uint64_t kLengthBytes = 4;
constexpr std::uint64_t kMaxHeaderBytes = std::uint64_t{1} << 20U;

Error damaged(const std::string& what) {
  return {ErrorCode::corrupt, "", what, "copy the bag again, or mend it with rosbag fix"};
}

}  // namespace

std::uint64_t little_endian(ByteView bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8U | bytes[i];
  return value;
}

Result<ByteView> ByteSource::bytes(std::uint64_t at, std::uint64_t count) {
  if (at > size() || size() - at < count) return damaged("is truncated or damaged");
  return read(at, count);
}

Result<ByteView> FileBytes::read(std::uint64_t at, std::size_t count) {
  buffer_.resize(count);
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(at));
  file_.read(reinterpret_cast<char*>(buffer_.data()), static_cast<std::streamsize>(count));
  if (file_) return ByteView(buffer_);
  return Error{ErrorCode::io, "", "cannot be read", "check the disk"};
}

Result<Ros1Fields> Ros1Fields::parse(ByteView bytes) {
  Ros1Fields fields;
  while (!bytes.empty()) {
    const std::uint64_t length = little_endian(bytes.first(std::min(bytes.size(), kLengthBytes)));
    if (bytes.size() < kLengthBytes || bytes.size() - kLengthBytes < length)
      return damaged("has a damaged record");
    const std::string_view field = as_text(bytes.subspan(kLengthBytes, length));
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) return damaged("has a damaged record");
    fields.fields_.emplace_back(field.substr(0, equals), field.substr(equals + 1));
    bytes = bytes.subspan(kLengthBytes + length);
  }
  return fields;
}

std::optional<std::string_view> Ros1Fields::text(std::string_view name) const {
  for (const auto& [known, value] : fields_)
    if (known == name) return value;
  return std::nullopt;
}

Result<std::uint64_t> Ros1Fields::number(std::string_view name) const {
  const auto value = text(name);
  if (value && !value->empty() && value->size() <= sizeof(std::uint64_t))
    return little_endian(as_bytes(*value));
  return damaged("has a record without '" + std::string(name) + "'");
}

Result<Ros1Record> ros1_record_at(ByteSource& source, std::uint64_t at) {
  const auto header_length = source.bytes(at, kLengthBytes);
  if (!header_length) return header_length.error();
  const std::uint64_t header_bytes = little_endian(*header_length);
  if (header_bytes > kMaxHeaderBytes) return damaged("has a damaged record");
  const auto header = source.bytes(at + kLengthBytes, header_bytes);
  if (!header) return header.error();
  auto fields = Ros1Fields::parse(*header);
  if (!fields) return fields.error();
  const auto op = fields->number("op");
  if (!op) return op.error();
  const std::uint64_t data_length_at = at + kLengthBytes + header_bytes;
  const auto data_length = source.bytes(data_length_at, kLengthBytes);
  if (!data_length) return data_length.error();
  Ros1Record record;
  record.op = static_cast<Ros1Op>(*op);
  record.header = std::move(*fields);
  record.data_at = data_length_at + kLengthBytes;
  record.data_bytes = static_cast<std::uint32_t>(little_endian(*data_length));
  if (source.size() - record.data_at < record.data_bytes) return damaged("is truncated or damaged");
  return record;
}

}  // namespace milepost::ros
