// Whether the positions of several drives are of one datum.
#pragma once

#include <vector>

#include "mapper/findings/finding.h"
#include "schema/base/result.h"
#include "schema/drive/drive.h"
#include "schema/geo/datum.h"

namespace milepost {

// That of all drives; not stated where none states it. It does not depend on their order. Errors:
// invalid_input (two drives state different ones).
Result<Datum> common_datum(const std::vector<Drive>& drives);

// Drives that state none beside others that do.
std::vector<Finding> datum_findings(const std::vector<Drive>& drives);

}  // namespace milepost
