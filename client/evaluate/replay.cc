#include "client/evaluate/replay.h"

#include <optional>

#include "client/evaluate/drive_playback.h"
#include "schema/drive/frame_image.h"
#include "schema/feature/extractor.h"
#include "schema/feature/wisurf.h"

namespace milepost {
namespace {

// A value computed from a frame when first needed, and the time that took.
template <class Value>
class MadeOnce {
 public:
  void forget() { made_ms_.reset(); }
  // Begins the turn of the next localizer.
  void begin_turn() { charged_ = false; }

  // Adds to `spared_ms`, once per turn, the time that the localizer would have spent on its own.
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

// The inputs of localizers computed from one frame at a time.
class FrameContent {
 public:
  explicit FrameContent(const Camera& camera) : camera_(camera) {}

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
      extractor_ = std::make_unique<FeatureExtractor>(parameters, camera_);
      parameters_ = parameters;
      features_.forget();
    }
    return features_.get([this] { return extractor_->extract(gray_); }, spared_ms_);
  }

  const ImageDescriptor& image() {
    return image_.get([this] { return wisurf(gray_); }, spared_ms_);
  }

  // The time saved in this turn because an earlier one had computed the value.
  double spared_ms() const { return spared_ms_; }

 private:
  Camera camera_;
  cv::Mat gray_;
  std::unique_ptr<FeatureExtractor> extractor_;
  FeatureParameters parameters_;
  MadeOnce<FeatureSet> features_;
  MadeOnce<ImageDescriptor> image_;
  double spared_ms_ = 0;
};

struct Runner {
  Localizer localizer;
  std::unique_ptr<std::vector<TrackletEstimate>> estimates;  // of the current frame
  bool had_fix = false;
};

// Passes the sensor readings up to a time to all localizers.
void tell(SensorLog& sensors, double timestamp_s, std::vector<Runner>& runners) {
  const std::span<const GpsFix> all_gps = sensors.gps_until(timestamp_s);
  const std::span<const Odometry> all_odometry = sensors.odometry_until(timestamp_s);
  for (Runner& runner : runners) {
    for (const GpsFix& gps : all_gps) {
      runner.localizer.observe(GnssFix{gps.timestamp_s, gps.position, gps.sigma_m});
    }
    for (const Odometry& odometry : all_odometry) runner.localizer.observe(odometry);
  }
}

// Limits the time a replay waits for map data: per frame and in total.
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

  // Whether hardly any time was spent waiting: an error that comes this soon is permanent.
  bool is_fresh() const { return left_s_ > kAllS - kAtOnceS; }

 private:
  static constexpr double kAllS = 60;
  static constexpr double kLongestS = 40;
  static constexpr double kAtOnceS = 3;
  double left_s_ = kAllS;
};

// That the drive's positions are of the datum of the maps that it is localized on.
class SameDatum {
 public:
  SameDatum(const Drive& drive, MapSource& source) : drive_(drive), source_(source) {}

  // Errors: invalid_input. A map that cannot be described now is not checked.
  Status check(const Fix& fix) {
    if (!drive_.datum.is_stated() || !fix.along_m || fix.version == checked_) return ok_status();
    const Result<MapDescription> map = source_.describe(fix.version);
    if (!map) return ok_status();
    checked_ = fix.version;
    return check_agree(drive_.datum, (drive_.folder / "drive.json").string(), map->datum,
                       "map '" + fix.version.map + "'");
  }

 private:
  const Drive& drive_;
  MapSource& source_;
  MapVersion checked_;
};

// Processes one frame with one localizer. An error of the source affects this frame only, except
// before the first fix, unless the source may become available by waiting.
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
  if (runner.localizer.last_error()) replay.outage = runner.localizer.last_error();
  return FrameFix{frame.filename, std::move(*fix), latency_ms, *runner.estimates};
}

}  // namespace

Result<Replay> replay_drive(const Drive& drive, const std::shared_ptr<MapSource>& source,
                            const std::vector<Method>& methods, bool with_estimates,
                            const std::function<bool(std::size_t)>& on_frame) {
  if (drive.gps.empty()) {
    return Error{ErrorCode::invalid_input, (drive.folder / "gps.csv").string(),
                 "there is no position to start from",
                 "add GNSS positions (timestamp_s,latitude_deg,longitude_deg,sigma_m)"};
  }
  std::vector<Runner> runners;
  for (const Method& method : methods) {
    LocalizerSettings settings;
    settings.method = method;
    auto estimates = std::make_unique<std::vector<TrackletEstimate>>();
    if (with_estimates) {
      settings.method_settings.on_estimate =
          [all = estimates.get()](const TrackletEstimate& estimate) { all->push_back(estimate); };
    }
    runners.push_back({Localizer(source, drive.camera, settings), std::move(estimates)});
  }

  Replay replay;
  replay.fixes.resize(methods.size());
  FrameContent content(drive.camera);
  const FrameReader frames(drive);
  SensorLog sensors(drive);
  TilePatience patience;
  SameDatum datum(drive, *source);
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
      if (const Status same = datum.check(fix->fix); !same) return same.error();
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
