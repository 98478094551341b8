// The files of a report page, embedded when the program was built.
#pragma once

#include <string_view>

namespace milepost {

struct ReportPageFiles {
  std::string_view page, style, library, licence, script;
};

ReportPageFiles report_page_files();

}  // namespace milepost
