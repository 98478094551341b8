#include "tests/client/evaluate/found_run.h"

#include "tests/client/evaluate/report/report_input.h"

namespace milepost::testing {
namespace {

const std::vector<Wall> kYard = {{{48.999, 8.399}, {49.001, 8.399}, 0.5},
                                 {{49.001, 8.399}, {49.001, 8.401}, 0.5},
                                 {{49.001, 8.401}, {48.999, 8.401}, 0.5},
                                 {{48.999, 8.401}, {48.999, 8.399}, 0.5}};

GlobalPoseEstimate made_up_fix(const Frame& truth, GlobalStatus status) {
  GlobalPoseEstimate fix;
  fix.timestamp_s = truth.timestamp_s;
  fix.status = status;
  fix.position = LocalFrame(truth.position).geo_from_enu({0, 2, 0});
  fix.heading_deg = 3;
  fix.sigma_m = 0.9;
  fix.heading_sigma_deg = 2;
  fix.mode_probability = 0.5;
  return fix;
}

}  // namespace

GlobalLocalizer idle_finder(std::size_t particles) {
  GlobalLocalizerSettings settings;
  settings.particles = particles;
  GlobalLocalizer localizer(kYard, {300, 300, 32, 24}, settings);
  localizer.find(cv::Mat::zeros(48, 64, CV_8UC1), 0);
  return localizer;
}

FoundRun::FoundRun(std::size_t frames, std::size_t found_from) : drive(straight_drive(frames)) {
  const GlobalLocalizer localizer = idle_finder(200);
  for (std::size_t i = 0; i < frames; ++i) {
    const Frame& frame = drive.frames[i];
    const GlobalStatus status =
        i < found_from ? GlobalStatus::initializing : GlobalStatus::tracking;
    found.push_back({frame.filename, made_up_fix(frame, status), 10 + static_cast<double>(i)});
    recorder.observe(i, status, localizer);
  }
}

FindReportInput FoundRun::input() const {
  FindReportInput input;
  input.map_name = "town (build 4f1c9a2b)";
  input.map_source = "town.map";
  input.drive = &drive;
  input.frames = &found;
  input.recorder = &recorder;
  return input;
}

}  // namespace milepost::testing
