#include "client/evaluate/find_drive.h"

#include <optional>

#include "client/evaluate/drive_playback.h"
#include "client/localize/localizer.h"
#include "schema/drive/frame_image.h"
#include "schema/feature/extractor.h"

namespace milepost {
namespace {

constexpr std::chrono::seconds kLongestWait(20);  // for the map data of one frame

// The localizer along roads after the hand-off: it receives the global fixes in place of GNSS
// fixes.
class RouteLocalizer {
 public:
  RouteLocalizer(const std::shared_ptr<MapSource>& source, const Camera& camera)
      : camera_(camera), localizer_(source, camera, LocalizerSettings()) {}

  void observe(const Odometry& odometry) { localizer_.observe(odometry); }

  // Map data that does not arrive affects this frame only. Errors: those of a map that the
  // localizer cannot use.
  Result<FrameFix> localize(const Frame& frame, const cv::Mat& gray,
                            const GlobalPoseEstimate& found, const Stopped& stopped) {
    if (found.status == GlobalStatus::tracking) {
      localizer_.observe(
          GnssFix{frame.timestamp_s, found.position, found.sigma_m, found.heading_deg});
    }
    localizer_.wait_for_tiles(frame.timestamp_s, std::chrono::steady_clock::now() + kLongestWait,
                              stopped);
    const Stopwatch watch;
    std::optional<FeatureSet> features;
    const QueryFrame query{frame.timestamp_s,
                           [&](const FeatureParameters& parameters) -> const FeatureSet& {
                             if (!features) {
                               features = FeatureExtractor(parameters, camera_).extract(gray);
                             }
                             return *features;
                           }};
    Result<Fix> fix = localizer_.localize(query);
    const double latency_ms = watch.ms();
    if (!fix) {
      if (!had_fix_ && fix.error().code != ErrorCode::unavailable) return fix.error();
      outage_ = fix.error();
      fix = fix_without_map(frame.timestamp_s, had_fix_);
    }
    if (localizer_.last_error()) outage_ = localizer_.last_error();
    had_fix_ = had_fix_ || fix->along_m.has_value();
    return FrameFix{frame.filename, std::move(*fix), latency_ms, {}};
  }

  const std::optional<Error>& outage() const { return outage_; }

 private:
  Camera camera_;
  Localizer localizer_;
  bool had_fix_ = false;
  std::optional<Error> outage_;
};

}  // namespace

Result<FoundDrive> find_drive(const Drive& drive, const std::vector<Wall>& walls,
                              const FindRun& run) {
  if (drive.odometry.empty()) {
    return Error{ErrorCode::invalid_input, (drive.folder / "odometry.csv").string(),
                 "the drive has no odometry",
                 "add the odometry readings (timestamp_s,speed_mps,yaw_rate_dps)"};
  }
  GlobalLocalizer localizer(walls, drive.camera, run.localizer);
  std::optional<RouteLocalizer> on_route;
  if (run.localizer_source) on_route.emplace(run.localizer_source, drive.camera);

  FoundDrive found;
  const FrameReader frames(drive);
  SensorLog sensors(drive);
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    const Frame& frame = drive.frames[i];
    const Result<cv::Mat> gray = frames.gray(i);
    if (!gray) return gray.error();
    for (const Odometry& odometry : sensors.odometry_until(frame.timestamp_s)) {
      localizer.observe(odometry);
      if (on_route) on_route->observe(odometry);
    }
    const Stopwatch watch;
    const GlobalPoseEstimate fix = localizer.find(*gray, frame.timestamp_s);
    found.frames.push_back({frame.filename, fix, watch.ms()});
    if (on_route) {
      Result<FrameFix> localized = on_route->localize(frame, *gray, fix, run.stopped);
      if (!localized) return localized.error();
      found.localized.push_back(std::move(*localized));
      found.outage = on_route->outage();
    }
    if (!run.on_frame(i, fix, localizer)) {
      return Error{ErrorCode::cancelled, drive.folder.string(),
                   "stopped on request, nothing was written", ""};
    }
  }
  return found;
}

}  // namespace milepost
