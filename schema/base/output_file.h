// Checks of a command's output files: none may replace an input, or a file of another kind.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "schema/base/result.h"

namespace milepost {

inline constexpr std::size_t kOutputHeadBytes = 4096;

// A kind of file that a command writes, and how an existing file of that kind is recognized.
struct OutputKind {
  const char* name;  // in messages: "a milepost map"
  // Whether a file of this kind begins with `head`: its first kOutputHeadBytes, or all of it.
  bool (*begins_with)(std::string_view head);
  // Whether it is written sequentially, so that it may go to a pipe or a device.
  bool may_be_stream;
};

struct Output {
  std::string option;  // by which the user names the file: "--map"
  std::filesystem::path file;
  const OutputKind* kind;
  const char* named = "file";  // what the option names: "folder" if the file's folder
};

// Checks, before any work is done, whether each output may be written. An existing regular file may
// be replaced if it is empty or of the output's kind; symbolic links are followed and kept. Pipes
// and character devices are written to where the kind allows it.
// Errors: invalid_input for an output that is one of `inputs` (by any name or link) or another
// output, for a file of another kind, a folder, a device; io for a folder without write access.
Status check_outputs(const std::vector<Output>& outputs,
                     const std::vector<std::filesystem::path>& inputs);

// Whether `head` begins with `start`, ignoring white space: JSON in any layout.
bool begins_without_space(std::string_view head, std::string_view start);

// A GeoJSON file of any origin that holds a FeatureCollection.
extern const OutputKind kGeoJsonOutput;

}  // namespace milepost
