# Included from client/CMakeLists.txt. Of the localizer and the drive the report needs headers only.
milepost_library(report
  SOURCES
    cli/plot/axis.cc
    cli/plot/chart.cc
    cli/plot/text.cc
    cli/report.cc
    cli/report_map.cc
    cli/report_route.cc
    cli/report_series.cc
    cli/report_spread.cc
    cli/report_style.cc
    cli/report_table.cc
  PUBLIC milepost::base milepost::geo)
