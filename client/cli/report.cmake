# Included from client/CMakeLists.txt. Of the localizer and the drive the report needs headers only.

# report.css goes into the library as it is; the laboratory reads the same file.
set(report_css ${CMAKE_CURRENT_SOURCE_DIR}/cli/report.css)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${report_css})
file(READ ${report_css} MILEPOST_REPORT_CSS)
configure_file(cli/report_style.cc.in ${PROJECT_BINARY_DIR}/generated/client/cli/report_style.cc @ONLY)

milepost_library(report
  SOURCES
    cli/plot/axis.cc
    cli/plot/chart.cc
    cli/plot/text.cc
    cli/report.cc
    cli/report_map.cc
    cli/report_numbers.cc
    cli/report_page.cc
    cli/report_plan.cc
    cli/report_route.cc
    cli/report_series.cc
    cli/report_spread.cc
    ${PROJECT_BINARY_DIR}/generated/client/cli/report_style.cc
    cli/report_table.cc
  PUBLIC milepost::base milepost::geo Eigen3::Eigen)
