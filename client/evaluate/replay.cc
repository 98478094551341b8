#include "client/evaluate/replay.h"

#include <optional>

#include "client/evaluate/drive_playback.h"
#include "schema/drive/frame_image.h"
#include "schema/feature/extractor.h"
#include "schema/feature/wisurf.h"

namespace milepost {
namespace {

// A value made from a frame when a localizer first asks for it, and the time that took.
template <class Value>
class MadeOnce {
 public:
  void forget() { made_ms_.reset(); }
  // Begins another localizer's turn.
  void begin_turn() { charged_ = false; }

  // Adds to `spared_ms`, once a turn, what a localizer on its own would have spent.
  template <class Make>
  const Value& get(const Make& make, double& spared_ms) {
    if (!made_ms_) {
      const Stopwatch watch;
      value_ = make();
      made_ms_ = watch.ms();
    } else if (!charged_) {
      spared_ms += *made_ms_;
    }
    charged_ = true;
    return value_;
  }

 private:
  Value value_{};
  std::optional<double> made_ms_;
  bool charged_ = false;
};

// What localizers ask of one frame at a time.
class FrameContent {
 public:
  void set_frame(cv::Mat gray) {
    gray_ = std::move(gray);
    features_.forget();
    image_.forget();
  }

  void begin_turn() {
    features_.begin_turn();
    image_.begin_turn();
    spared_ms_ = 0;
  }

  const FeatureSet& features(const FeatureParameters& parameters) {
    if (!extractor_ || !(parameters == parameters_)) {
      extractor_ = std::make_unique<FeatureExtractor>(parameters);
      parameters_ = parameters;
      features_.forget();
    }
    return features_.get([this] { return extractor_->extract(gray_); }, spared_ms_);
  }

  const ImageDescriptor& image() {
    return image_.get([this] { return wisurf(gray_); }, spared_ms_);
  }

  // What this turn did not take because an earlier one had made it.
  double spared_ms() const { return spared_ms_; }

 private:
  cv::Mat gray_;
  std::unique_ptr<FeatureExtractor> extractor_;
  FeatureParameters parameters_;
  MadeOnce<FeatureSet> features_;
  MadeOnce<ImageDescriptor> image_;
  double spared_ms_ = 0;
};

struct Runner {
  Localizer localizer;
  std::unique_ptr<std::vector<TrackletEstimate>> estimates;  // of the frame it is at
  bool had_fix = false;
};

// What the sensors said up to a time.
void tell(SensorLog& sensors, double timestamp_s, std::vector<Runner>& runners) {
  const std::span<const GpsFix> all_gps = sensors.gps_until(timestamp_s);
  const std::span<const Odometry> all_odometry = sensors.odometry_until(timestamp_s);
  for (Runner& runner : runners) {
    for (const GpsFix& gps : all_gps) {
      runner.localizer.observe(CoarsePosition{gps.timestamp_s, gps.position, gps.sigma_m});
    }
    for (const Odometry& odometry : all_odometry) runner.localizer.observe(odometry);
  }
}

// How long a replay may wait for the map: for one frame, and in all.
class TilePatience {
 public:
  void wait(Localizer& localizer, double timestamp_s, const Stopped& stopped) {
    const Stopwatch watch;
    const std::chrono::duration<double> longest(std::min(kLongestS, left_s_));
    localizer.wait_for_tiles(
        timestamp_s,
        std::chrono::steady_clock::now() +
            std::chrono::duration_cast<std::chrono::steady_clock::duration>(longest),
        stopped);
    left_s_ -= watch.ms() / 1000;
  }

  // Whether nothing was waited for that may come late: what failed so soon fails for good.
  bool is_fresh() const { return left_s_ > kAllS - kAtOnceS; }

 private:
  static constexpr double kAllS = 60;
  static constexpr double kLongestS = 40;
  static constexpr double kAtOnceS = 3;
  double left_s_ = kAllS;
};

// One frame through one localizer. A source that does not answer costs this frame only, but one
// that is not there from the beginning.
Result<FrameFix> run_frame(const Frame& frame, FrameContent& content, const TilePatience& patience,
                           Runner& runner, Replay& replay) {
  content.begin_turn();
  runner.estimates->clear();
  const QueryFrame query{frame.timestamp_s,
                         [&](const FeatureParameters& parameters) -> const FeatureSet& {
                           return content.features(parameters);
                         },
                         [&]() -> const ImageDescriptor& { return content.image(); }};
  const Stopwatch watch;
  Result<Fix> fix = runner.localizer.localize(query);
  const double latency_ms = watch.ms() + content.spared_ms();
  if (!fix) {
    const bool may_come = fix.error().code == ErrorCode::unavailable && !patience.is_fresh();
    if (!runner.had_fix && !may_come) return fix.error();
    replay.outage = fix.error();
    fix = fix_without_map(frame.timestamp_s, runner.had_fix);
  }
  runner.had_fix = runner.had_fix || fix->along_m.has_value();
  if (runner.localizer.noted_error()) replay.outage = runner.localizer.noted_error();
  return FrameFix{frame.filename, std::move(*fix), latency_ms, *runner.estimates};
}

}  // namespace

Result<Replay> replay_drive(const Drive& drive, const std::shared_ptr<MapSource>& source,
                            const std::vector<Method>& methods, bool with_estimates,
                            const std::function<bool(std::size_t)>& on_frame) {
  if (drive.gps.empty()) {
    return Error{ErrorCode::invalid_input, (drive.folder / "gps.csv").string(),
                 "there is no position to start from",
                 "add the receiver's positions (timestamp_s,latitude_deg,longitude_deg,sigma_m)"};
  }
  std::vector<Runner> runners;
  for (const Method& method : methods) {
    LocalizerSettings settings;
    settings.method = method;
    auto estimates = std::make_unique<std::vector<TrackletEstimate>>();
    if (with_estimates) {
      settings.scout.on_estimate = [all = estimates.get()](const TrackletEstimate& estimate) {
        all->push_back(estimate);
      };
    }
    runners.push_back({Localizer(source, drive.camera, settings), std::move(estimates)});
  }

  Replay replay;
  replay.fixes.resize(methods.size());
  FrameContent content;
  const FrameReader frames(drive);
  SensorLog sensors(drive);
  TilePatience patience;
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    const Frame& frame = drive.frames[i];
    Result<cv::Mat> gray = frames.gray(i);
    if (!gray) return gray.error();
    content.set_frame(std::move(*gray));
    tell(sensors, frame.timestamp_s, runners);
    for (Runner& runner : runners) {
      patience.wait(runner.localizer, frame.timestamp_s, [&] { return !on_frame(i); });
    }
    for (std::size_t m = 0; m < methods.size(); ++m) {
      Result<FrameFix> fix = run_frame(frame, content, patience, runners[m], replay);
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
