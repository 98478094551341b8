// From the options to the settings of a server, with the content of the files that they name.
#pragma once

#include <memory>
#include <vector>

#include "schema/base/result.h"
#include "server/current/followed_files.h"
#include "server/options.h"

namespace milepost::server {

struct Setup {
  ServerSettings settings;
  std::vector<std::unique_ptr<FollowedFiles>> followed;  // to be looked at from time to time
};

// Errors: those of Viewer::with, TlsContext::load and Tokens::read.
Result<Setup> set_up(const Options& options);

}  // namespace milepost::server
