#include "tests/support/temp_folder.h"

#include <stdlib.h>

#include <stdexcept>
#include <string>

namespace milepost::testing {

TempFolder::TempFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "milepost-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder: " + name);
  path_ = name;
}

TempFolder::~TempFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace milepost::testing
