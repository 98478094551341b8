// A program that has only the installed client: it asks a server that is not there where it is, and
// must be told so; and looks for itself among walls in the dark, and must not find itself.
#include <iostream>
#include <memory>

#include <opencv2/core.hpp>

#include "client/fetch/http_source.h"
#include "client/global/finder.h"
#include "client/localize/localizer.h"
#include "schema/feature/extractor.h"

namespace {

bool is_told_that_the_server_is_not_there(const std::string& work_directory) {
  milepost::HttpSourceSettings server;
  server.server_url = "http://127.0.0.1:1";  // port 1 is never the one of a tile server
  server.cache_directory = work_directory + "/cache";
  server.attempts = 1;
  auto source = milepost::open_http_source(server);
  if (!source) {
    std::cerr << source.error().line() << "\n";
    return false;
  }

  milepost::LocalizerSettings settings;
  milepost::Localizer localizer(std::shared_ptr<milepost::MapSource>(std::move(source).value()),
                                {.width_px = 64, .focal_x_px = 50, .focal_y_px = 50}, settings);
  milepost::FeatureSet features;
  localizer.observe({.timestamp_s = 0, .position = {49.0, 8.4, 110}, .sigma_m = 5});
  const auto fix = localizer.localize(
      {.timestamp_s = 0,
       .features =
           [&](const milepost::FeatureParameters& parameters) -> const milepost::FeatureSet& {
         const cv::Mat gray(64, 64, CV_8UC1, cv::Scalar(0));
         features = milepost::FeatureExtractor(parameters).extract(gray);
         return features;
       }});
  if (fix) {
    std::cerr << "a server that is not there gave a fix\n";
    return false;
  }
  std::cout << fix.error().line() << "\n";
  return fix.error().code == milepost::ErrorCode::unavailable;
}

bool is_not_found_in_the_dark() {
  const std::vector<milepost::Wall> walls = {{{49.001, 8.4}, {49.001, 8.401}, 0.2}};
  milepost::Finder finder(walls, {.focal_x_px = 50, .focal_y_px = 50}, {});
  const cv::Mat gray(64, 64, CV_8UC1, cv::Scalar(0));
  milepost::FindFix fix;
  for (int i = 0; i < 5; ++i) {
    finder.observe({.timestamp_s = 0.1 * i, .speed_mps = 10});
    fix = finder.find(gray, 0.1 * i);
  }
  std::cout << "in the dark: " << milepost::name_of(fix.status) << "\n";
  return fix.status == milepost::FindStatus::initializing;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  return is_told_that_the_server_is_not_there(argv[1]) && is_not_found_in_the_dark() ? 0 : 1;
}
