// Drives through a town, recorded into drive folders.
#pragma once

#include <filesystem>

#include "schema/base/result.h"
#include "tests/simulator/parallel.h"
#include "tests/simulator/runs.h"
#include "tests/simulator/town.h"

namespace milepost::simulator {

// Whether `folder` holds the frames of the same run, of which perhaps only the stated positions
// differ. Only runs that keep their frames are known again.
bool has_recorded(const Town& town, const RunPlan& run, const std::filesystem::path& folder);

// Writes the drive's description and tables, without its frames. Errors: as of record().
Status record_tables(const Town& town, const RunPlan& run, const std::filesystem::path& folder);

// Renders the run's frames on `threads` threads and writes the drive into `folder`; tables are
// written last, so an unfinished folder is not a drive. The same town and run give the same bytes
// for any number of threads.
// Errors: io; invalid_input for an invalid run (no distance, no spacing, no speed, no such route);
// cancelled.
Status record(const Town& town, const Lighting& lighting, const RunPlan& run,
              const std::filesystem::path& folder, int threads, const Progress& progress = {});

}  // namespace milepost::simulator
