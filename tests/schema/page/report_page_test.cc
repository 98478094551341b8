// The page of a report: it is self-contained.
#include "schema/page/report_page.h"

#include <gmock/gmock.h>

#include <regex>

namespace milepost {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string embedded(const std::string& page) {
  const std::string opening = R"(<script type="application/json" id="data">)";
  const std::size_t start = page.find(opening) + opening.size();
  return page.substr(start, page.find("</script>", start) - start);
}

TEST(ReportPage, HoldsTheDataTheLibraryAndItsLicence) {
  const Json data = {{"kind", "test"}, {"title", "a <b> & \u2028 c"}};
  const std::string page = report_page(data);
  EXPECT_EQ(Json::parse(embedded(page)), data);
  EXPECT_THAT(page, HasSubstr("Chart.js v3."));
  EXPECT_THAT(page, HasSubstr("The above copyright notice and this permission notice shall be"));
  EXPECT_THAT(page, HasSubstr("<noscript>"));
  EXPECT_THAT(page.substr(page.size() - 100), Not(HasSubstr("@")));
  EXPECT_TRUE(kReportOutput.begins_with(std::string_view(page).substr(0, kOutputHeadBytes)));
}

TEST(ReportPage, LoadsNothingAndRunsItsOwnScriptsOnly) {
  const std::string page = report_page(Json::object());
  for (const char* loader : {"<link", "<img", " src=", "url(", "@import", "href=\"http"}) {
    EXPECT_THAT(page, Not(HasSubstr(loader)));
  }
  EXPECT_TRUE(std::regex_search(
      page, std::regex("default-src 'none'; style-src 'unsafe-inline'; img-src data:; "
                       "script-src 'sha256-[A-Za-z0-9+/]{43}=' 'sha256-[A-Za-z0-9+/]{43}='\"")));
}

}  // namespace
}  // namespace milepost
