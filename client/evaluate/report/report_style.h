// The look of the report.
#pragma once

#include <string_view>

namespace milepost {

// CSS for light and dark screens, phones and paper. Holds neither '<' nor '&'.
std::string_view report_style();

}  // namespace milepost
