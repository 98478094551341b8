// Map files as outputs of commands.
#pragma once

#include "schema/base/output_file.h"

namespace milepost {

// A map of any version of the format, known by the application_id in SQLite's header.
extern const OutputKind kMapOutput;

}  // namespace milepost
