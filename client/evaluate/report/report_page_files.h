// The files that a report's page is made from, as they were when the program was built.
#pragma once

#include <string_view>

namespace milepost {

struct ReportPageFiles {
  std::string_view page, style, library, licence, script;
};

ReportPageFiles report_page_files();

}  // namespace milepost
