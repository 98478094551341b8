// Where a command may write: never over a file that it reads, nor over one of another kind.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "schema/base/result.h"

namespace milepost {

inline constexpr std::size_t kOutputHeadBytes = 4096;

// What a command writes, and how an older file of that kind is known.
struct OutputKind {
  const char* name;  // in messages: "a milepost map"
  // Whether a file of this kind begins with `head`: its first kOutputHeadBytes, or all of it.
  bool (*begins_with)(std::string_view head);
  // Whether it is written from beginning to end in one go, so that a pipe or a device will do.
  bool may_be_stream;
};

struct Output {
  std::string option;  // by which the user names the file: "--map"
  std::filesystem::path file;
  const OutputKind* kind;
  const char* named = "file";  // by the option: "folder" where it names the folder of the file
};

// Whether each output may be written, asked before any work is done for it. What lies there may be
// replaced if it is a regular file of the output's kind or without content; a symbolic link counts
// as what it leads to, and stays. A pipe or a character device is written to where the kind allows.
// Errors: invalid_input for an output that is one of `inputs` (by whatever name or link) or another
// output, for a file of another kind, a folder, a device; io for a folder that takes no files.
Status check_outputs(const std::vector<Output>& outputs,
                     const std::vector<std::filesystem::path>& inputs);

// Whether `head` begins with `start`, white space in it passed over: JSON, however it was laid out.
bool begins_without_space(std::string_view head, std::string_view start);

// A GeoJSON file, whoever wrote it, if it holds a FeatureCollection.
extern const OutputKind kGeoJsonOutput;

}  // namespace milepost
