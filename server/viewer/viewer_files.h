// The files of the viewer, embedded when the server was built.
#pragma once

#include <string_view>
#include <vector>

namespace milepost::server {

struct ViewerFile {
  std::string_view name;  // "app.js"
  std::string_view text;
};

const std::vector<ViewerFile>& viewer_files();

}  // namespace milepost::server
