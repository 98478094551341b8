// Findings about rows of trajectory.csv.
#pragma once

#include <string>

#include "mapper/findings/finding.h"
#include "schema/drive/drive.h"

namespace milepost {

inline Finding on_trajectory(const Drive& drive, const std::string& kind, const Frame& first,
                             std::size_t count, const std::string& what, const std::string& hint) {
  return {kind, (drive.folder / "trajectory.csv").string(), first.line, count, what, hint};
}

}  // namespace milepost
