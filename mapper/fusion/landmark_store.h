// The landmarks of all drives between surveying and fusing: in a temporary file, so that memory
// does not grow with the drives.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapper/fusion/pass_landmark.h"
#include "schema/base/result.h"
#include "schema/store/sqlite.h"

namespace milepost {

// Not safe to use from several threads at once. Errors of all below: io (disk full).
class LandmarkStore {
 public:
  static Result<LandmarkStore> create();

  Status add(std::size_t segment, std::uint32_t tile, const PassLandmark& landmark);
  // The landmarks of a tile by begin; those with equal begin, as they were added.
  Result<std::vector<PassLandmark>> read(std::size_t segment, std::uint32_t tile);

 private:
  LandmarkStore(sqlite::Database database, sqlite::Statement insert, sqlite::Statement select)
      : database_(std::move(database)), insert_(std::move(insert)), select_(std::move(select)) {}

  sqlite::Database database_;
  sqlite::Statement insert_;
  sqlite::Statement select_;
};

}  // namespace milepost
