// What the heads of the reports tell of a drive.
#pragma once

#include <string>

#include "schema/drive/drive.h"
#include "schema/page/report_json.h"

namespace milepost {

// When the drive was captured, its frames, where it comes from and its licence.
Facts facts_of(const Drive& drive);
std::string title_of(const Drive& drive);  // or a placeholder if it has none

}  // namespace milepost
