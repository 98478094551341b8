#include "client/cli/replay.h"

#include <chrono>

#include "schema/drive/frame_image.h"
#include "schema/feature/extractor.h"

namespace milepost {
namespace {

// Drives write receiver times to the millisecond and frame times finer.
constexpr double kClockRoundingS = 0.001;

using SteadyClock = std::chrono::steady_clock;

double ms_since(SteadyClock::time_point start) {
  return std::chrono::duration<double, std::milli>(SteadyClock::now() - start).count();
}

// The features of one frame at a time, extracted when first asked for, and the time that took.
class FrameFeatures {
 public:
  void set_frame(cv::Mat gray) {
    gray_ = std::move(gray);
    extracted_ = false;
    extraction_ms_ = 0;
  }

  const FeatureSet& get(const FeatureParameters& parameters) {
    if (!extractor_ || !(parameters == parameters_)) {
      extractor_ = std::make_unique<FeatureExtractor>(parameters);
      parameters_ = parameters;
      extracted_ = false;
    }
    if (!extracted_) {
      const auto start = SteadyClock::now();
      features_ = extractor_->extract(gray_);
      extraction_ms_ = ms_since(start);
      extracted_ = true;
    }
    return features_;
  }

  bool extracted() const { return extracted_; }
  double extraction_ms() const { return extraction_ms_; }

 private:
  cv::Mat gray_;
  std::unique_ptr<FeatureExtractor> extractor_;
  FeatureParameters parameters_;
  FeatureSet features_;
  bool extracted_ = false;
  double extraction_ms_ = 0;
};

struct Runner {
  Localizer localizer;
  bool had_fix = false;
};

// One frame through one localizer. A source that fails after the first fix costs this frame only.
Result<FrameFix> run_frame(const Frame& frame, FrameFeatures& features, Runner& runner,
                           Replay& replay) {
  bool asked = false;
  const bool extracted_before = features.extracted();
  const QueryFrame query{frame.timestamp_s,
                         [&](const FeatureParameters& parameters) -> const FeatureSet& {
                           asked = true;
                           return features.get(parameters);
                         }};
  const auto start = SteadyClock::now();
  Result<Fix> fix = runner.localizer.localize(query);
  double latency_ms = ms_since(start);
  if (asked && extracted_before) latency_ms += features.extraction_ms();
  if (!fix) {
    if (!runner.had_fix) return fix.error();
    replay.outage = fix.error();
    Fix lost;
    lost.timestamp_s = frame.timestamp_s;
    lost.status = FixStatus::lost;
    fix = lost;
  }
  runner.had_fix = runner.had_fix || fix->along_m.has_value();
  if (runner.localizer.noted_error()) replay.outage = runner.localizer.noted_error();
  return FrameFix{frame.filename, std::move(*fix), latency_ms};
}

}  // namespace

Result<Replay> replay_drive(const Drive& drive, const std::shared_ptr<MapSource>& source,
                            const std::vector<Method>& methods,
                            const std::function<bool(std::size_t)>& on_frame) {
  if (drive.gps.empty()) {
    return Error{ErrorCode::invalid_input, (drive.folder / "gps.csv").string(),
                 "there is no position to start from",
                 "add the receiver's positions (timestamp_s,latitude_deg,longitude_deg,sigma_m)"};
  }
  std::vector<Runner> runners;
  const QueryCamera camera{drive.camera.width_px, drive.camera.focal_x_px, drive.camera.focal_y_px};
  for (const Method& method : methods) {
    LocalizerSettings settings;
    settings.method = method;
    runners.push_back({Localizer(source, camera, settings)});
  }

  Replay replay;
  replay.fixes.resize(methods.size());
  FrameFeatures features;
  std::size_t next_gps = 0;
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    const Frame& frame = drive.frames[i];
    Result<cv::Mat> gray = read_frame_gray(drive, i);
    if (!gray) return gray.error();
    features.set_frame(std::move(*gray));
    for (; next_gps < drive.gps.size() &&
           drive.gps[next_gps].timestamp_s <= frame.timestamp_s + kClockRoundingS;
         ++next_gps) {
      const GpsFix& gps = drive.gps[next_gps];
      for (Runner& runner : runners)
        runner.localizer.observe({gps.timestamp_s, gps.position, gps.sigma_m});
    }
    for (std::size_t m = 0; m < methods.size(); ++m) {
      Result<FrameFix> fix = run_frame(frame, features, runners[m], replay);
      if (!fix) return fix.error();
      replay.fixes[m].push_back(std::move(*fix));
    }
    if (!on_frame(i + 1)) {
      return Error{ErrorCode::cancelled, drive.folder.string(),
                   "stopped on request, nothing was written", ""};
    }
  }
  return replay;
}

}  // namespace milepost
