// A small valid drive in a temporary folder, of which tests damage one part.
#pragma once

#include <filesystem>
#include <string>

#include "tests/support/temp_folder.h"

namespace milepost {

class DriveFolder {
 public:
  DriveFolder();  // four local frames of 16x12 pixels, 2 m and 0.2 s apart, driven north

  const std::filesystem::path& path() const { return folder_.path(); }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  void write(const std::string& name, const std::string& content) const;
  std::string read(const std::string& name) const;
  // Replaces the only occurrence of `old_text` in the file; fails the test if there is none.
  void replace(const std::string& name, const std::string& old_text,
               const std::string& new_text) const;
  // Replaces a line of a table; the header is line 1.
  void replace_line(const std::string& name, std::size_t line, const std::string& text) const;

 private:
  testing::TempFolder folder_;
};

// The one-line error of a bad drive.
std::string refusal(const DriveFolder& folder);

}  // namespace milepost
