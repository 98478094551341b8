#include "schema/base/output_file.h"

#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <optional>
#include <system_error>

namespace milepost {
namespace fs = std::filesystem;
namespace {

Error refused(const Output& output, const std::string& what, const std::string& hint) {
  return {ErrorCode::invalid_input, output.file.string(), what, hint};
}

std::string other_file(const Output& output) {
  return std::string("give another ") + output.named + " with " + output.option;
}

// Whether two paths refer to the same file, which need not exist.
bool are_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  if (a.filename() != b.filename()) return false;  // avoids file system access for most paths
  const fs::path real_a = fs::weakly_canonical(a, error);
  return !error && real_a == fs::weakly_canonical(b, error) && !error;
}

bool is_stream(const Output& output) {
  std::error_code ignored;
  const fs::file_type type = fs::status(output.file, ignored).type();
  return type == fs::file_type::fifo || type == fs::file_type::character;
}

Status check_is_no_input(const Output& output, const std::vector<fs::path>& inputs) {
  for (const fs::path& input : inputs) {
    if (!are_same_file(output.file, input)) continue;
    return refused(output, "the command reads this file, and would replace it", other_file(output));
  }
  return ok_status();
}

// Whether a file can be created in the folder of the output.
Status check_folder(const Output& output) {
  const fs::path parent = output.file.parent_path();
  const fs::path folder = parent.empty() ? fs::path(".") : parent;
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    return Error{ErrorCode::io, output.file.string(), "there is no folder " + folder.string(),
                 "create it, or " + other_file(output)};
  }
  if (::access(folder.c_str(), W_OK | X_OK) == 0) return ok_status();
  return Error{ErrorCode::io, output.file.string(),
               "no file can be created in " + folder.string() + " (" +
                   std::generic_category().message(errno) + ")",
               other_file(output)};
}

std::optional<std::string> head_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(kOutputHeadBytes, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (stream.bad() || !stream.is_open()) return std::nullopt;
  head.resize(static_cast<std::size_t>(stream.gcount()));
  return head;
}

Status check_kind(const Output& output) {
  const std::optional<std::string> head = head_of(output.file);
  if (!head) {
    return Error{ErrorCode::io, output.file.string(),
                 "the existing file cannot be read, so it is not replaced",
                 other_file(output) + ", or remove this one first"};
  }
  if (head->empty() || output.kind->begins_with(*head)) return ok_status();
  return refused(
      output,
      std::string("the existing file is not ") + output.kind->name + ", so it is not replaced",
      other_file(output) + ", or remove this one first");
}

Status check_stream(const Output& output) {
  if (output.kind->may_be_stream) return ok_status();
  return refused(output, std::string(output.kind->name) + " is not written to a device or a pipe",
                 "give a regular file with " + output.option);
}

Status check_place(const Output& output) {
  std::error_code error;
  switch (fs::status(output.file, error).type()) {
    case fs::file_type::not_found:
      break;
    case fs::file_type::regular:
      if (Status kind = check_kind(output); !kind) return kind;
      break;
    case fs::file_type::fifo:
    case fs::file_type::character:
      return check_stream(output);
    case fs::file_type::directory:
      return refused(output, "this is a folder", "give a file with " + output.option);
    case fs::file_type::none:
      return Error{ErrorCode::io, output.file.string(),
                   "cannot be reached (" + error.message() + ")", other_file(output)};
    default:
      return refused(output, "this is not a regular file", other_file(output));
  }
  if (output.file.filename().empty()) {
    return refused(output, "this is not the name of a file", "give a file with " + output.option);
  }
  return check_folder(output);
}

bool begins_collection(std::string_view head) {
  return begins_without_space(head, "{") &&
         head.find("\"FeatureCollection\"") != std::string_view::npos;
}

}  // namespace

const OutputKind kGeoJsonOutput = {"a GeoJSON FeatureCollection", begins_collection, true};

Status check_outputs(const std::vector<Output>& outputs, const std::vector<fs::path>& inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (Status input = check_is_no_input(outputs[i], inputs); !input) return input;
    if (Status place = check_place(outputs[i]); !place) return place;
    for (std::size_t before = 0; before < i; ++before) {
      if (is_stream(outputs[i]) || !are_same_file(outputs[i].file, outputs[before].file)) continue;
      return refused(outputs[i],
                     outputs[before].option + " and " + outputs[i].option + " name the same file",
                     "give each a file of its own");
    }
  }
  return ok_status();
}

bool begins_without_space(std::string_view head, std::string_view start) {
  for (const char c : head) {
    if (start.empty()) return true;
    if (c == ' ' || c == '\t' || c == '\r' || c == '\n') continue;
    if (c != start.front()) return false;
    start.remove_prefix(1);
  }
  return start.empty();
}

}  // namespace milepost
