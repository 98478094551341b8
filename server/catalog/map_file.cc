#include "server/catalog/map_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <string_view>
#include <system_error>
#include <vector>

#include "schema/base/ids.h"
#include "schema/store/map_content.h"

namespace milepost::server {
namespace fs = std::filesystem;
namespace {

// The header of a SQLite file (https://www.sqlite.org/fileformat.html, section 1.3). Its numbers
// are big-endian.
constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);
constexpr std::size_t kSqliteHeaderBytes = 100;
constexpr std::size_t kPageBytesAt = 16;  // two bytes; 1 stands for 65536
constexpr std::size_t kChangesAt = 24;    // four bytes, like all below
constexpr std::size_t kPagesAt = 28;
constexpr std::size_t kApplicationIdAt = 68;
constexpr std::size_t kPagesValidForAt = 92;  // the number of changes that kPagesAt belongs to

Error no_map(const fs::path& file, const std::string& what) {
  return {ErrorCode::invalid_input, file.string(), what, "move it elsewhere"};
}

Error half_copied(const fs::path& file, const std::string& what) {
  return {ErrorCode::corrupt, file.string(), what, "copy the map again, or remove the file"};
}

Error unreadable(const fs::path& file, const std::string& how, const std::string& why) {
  return {ErrorCode::io, file.string(), "cannot be " + how + " (" + why + ")",
          "let the server's user read the file, or remove it"};
}

std::string reason(int error) { return std::generic_category().message(error); }

Status check_kind(const fs::path& file) {
  std::error_code error;
  switch (fs::status(file, error).type()) {
    case fs::file_type::regular:
      return ok_status();
    case fs::file_type::directory:
      return no_map(file, "is a directory, whose files are not served");
    case fs::file_type::fifo:
      return no_map(file, "is a FIFO, not a map file");
    case fs::file_type::socket:
      return no_map(file, "is a socket, not a map file");
    case fs::file_type::block:
    case fs::file_type::character:
      return no_map(file, "is a device, not a map file");
    case fs::file_type::not_found:
      break;
    default:
      return unreadable(file, "reached", error.message());
  }
  const fs::path target = fs::read_symlink(file, error);
  const std::string what =
      error ? "no longer exists" : "is a link to " + target.string() + ", which does not exist";
  return Error{ErrorCode::not_found, file.string(), what, "correct or remove the link"};
}

struct FileHead {
  std::array<unsigned char, kSqliteHeaderBytes> bytes{};
  std::size_t read = 0;  // of them
  std::uintmax_t file_bytes = 0;

  std::string_view text() const { return {reinterpret_cast<const char*>(bytes.data()), read}; }
  std::uint64_t number(std::size_t at, std::size_t count) const {
    std::uint64_t value = 0;
    for (std::size_t i = at; i < at + count; ++i) value = value * 256 + bytes[i];
    return value;
  }
};

Result<FileHead> read_head(const fs::path& file) {
  // O_NONBLOCK in case it has become a FIFO meanwhile.
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0) return unreadable(file, "opened", reason(errno));
  FileHead head;
  const ssize_t read = ::pread(descriptor, head.bytes.data(), head.bytes.size(), 0);
  const int read_error = errno;
  const off_t end = ::lseek(descriptor, 0, SEEK_END);
  ::close(descriptor);
  if (read < 0 || end < 0) return unreadable(file, "read", reason(read_error));
  head.read = static_cast<std::size_t>(read);
  head.file_bytes = static_cast<std::uintmax_t>(end);
  return head;
}

// The file length that the header states, or 0 if it states none: an old SQLite wrote it, or it is
// damaged, which SQLite reports in more detail.
std::uint64_t promised_bytes(const FileHead& head) {
  const std::uint64_t stored = head.number(kPageBytesAt, 2);
  const std::uint64_t page_bytes = stored == 1 ? 65536 : stored;
  const bool pages_hold = head.number(kChangesAt, 4) == head.number(kPagesValidForAt, 4);
  if (!std::has_single_bit(page_bytes) || page_bytes < 512 || !pages_hold) return 0;
  return page_bytes * head.number(kPagesAt, 4);
}

// Checks that the file holds all pages that the header states.
Status check_length(const fs::path& file, const FileHead& head) {
  const bool has_header = head.read == head.bytes.size();
  const std::uint64_t promised = has_header ? promised_bytes(head) : 0;
  if (has_header && head.file_bytes >= promised) return ok_status();
  std::string what = "is truncated: it has " + std::to_string(head.file_bytes) + " bytes";
  if (has_header) what += " of " + std::to_string(promised);
  return half_copied(file, what);
}

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// The lower-case extensions of "town.map.bak": all parts after a dot, except a leading one.
std::vector<std::string> extensions_of(const std::string& name) {
  std::vector<std::string> parts;
  for (std::size_t dot = name.find('.', 1); dot != std::string::npos;) {
    const std::size_t next = name.find('.', dot + 1);
    parts.push_back(lower_case(name.substr(dot + 1, next - dot - 1)));
    dot = next;
  }
  return parts;
}

// Whether something follows the extension of a database, as in "town.map.bak" and "town.db-old", or
// the extension is one that programs give to copies and to partial files.
bool is_copy_or_part(const std::string& file_name) {
  static constexpr std::array<std::string_view, 5> kDatabase = {"map", "db", "db3", "sqlite",
                                                                "sqlite3"};
  static constexpr std::array<std::string_view, 8> kCopy = {"bak", "old",  "orig", "save",
                                                            "tmp", "temp", "part", "partial"};
  const auto is_one_of = [](const auto& list, const std::string& extension) {
    return std::ranges::find(list, extension) != list.end();
  };
  std::vector<std::string> extensions = extensions_of(file_name);
  if (extensions.empty()) return file_name.ends_with('~');
  const std::string last = extensions.back();
  extensions.pop_back();
  for (const std::string& extension : extensions) {
    if (is_one_of(kDatabase, extension)) return true;
  }
  if (is_one_of(kDatabase, last)) return false;
  const auto goes_on = [&last](std::string_view database) {  // "map~", "map_2", "map (copy)"
    return last.starts_with(database) &&
           std::isalpha(static_cast<unsigned char>(last[database.size()])) == 0;
  };
  return last.ends_with('~') || is_one_of(kCopy, last) || std::ranges::any_of(kDatabase, goes_on);
}

}  // namespace

Status check_map_file(const fs::path& file) {
  const Status kind = check_kind(file);
  if (!kind) return kind;
  const Result<FileHead> head = read_head(file);
  if (!head) return head.error();
  if (head->file_bytes == 0) {
    return Error{ErrorCode::invalid_input, file.string(), "is empty",
                 "copy the map again, or remove the file"};
  }
  if (!head->text().starts_with(kSqliteMagic)) {
    return no_map(file, "is not a milepost map and is skipped (it is not an SQLite file)");
  }
  const Status length = check_length(file, *head);
  if (head->number(kApplicationIdAt, 4) == kMapApplicationId) return length;
  if (head->read < head->bytes.size()) return length;
  return no_map(file, "is not a milepost map and is skipped (it is another program's SQLite file)");
}

bool is_named_as_map(const fs::path& file) {
  return lower_case(file.extension().string()) == ".map";
}

Result<std::string> map_name_of(const fs::path& file) {
  std::string name = file.stem().string();
  if (is_copy_or_part(file.filename().string())) {
    return Error{ErrorCode::invalid_input, file.string(), "is named like a copy or a part of a map",
                 "remove it, or rename it to NAME.map to serve it"};
  }
  if (is_segment_id(name)) return name;
  return Error{ErrorCode::invalid_input, file.string(),
               "the map's name '" + name + "' cannot be used in a URL",
               "rename the file with 1 to 64 of A-Z a-z 0-9 . _ -"};
}

}  // namespace milepost::server
