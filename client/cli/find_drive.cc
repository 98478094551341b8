#include "client/cli/find_drive.h"

#include <chrono>
#include <optional>

#include "client/localize/localizer.h"
#include "schema/drive/frame_image.h"
#include "schema/feature/extractor.h"

namespace milepost {
namespace {

using SteadyClock = std::chrono::steady_clock;

double ms_since(SteadyClock::time_point start) {
  return std::chrono::duration<double, std::milli>(SteadyClock::now() - start).count();
}

// The route localizer, which hears of the finder what it else hears of a receiver.
class Successor {
 public:
  Successor(std::shared_ptr<MapSource> source, const Camera& camera)
      : localizer_(std::move(source),
                   {camera.width_px, camera.focal_x_px, camera.focal_y_px, camera.principal_x_px,
                    camera.principal_y_px},
                   settings()) {}

  void observe(const OdometryReading& wheels) {
    localizer_.observe(Odometry{wheels.timestamp_s, wheels.speed_mps, wheels.yaw_rate_dps});
  }

  Result<FrameFix> localize(const Frame& frame, const cv::Mat& gray, const FindFix& found) {
    const auto start = SteadyClock::now();
    if (found.status == FindStatus::tracking) {
      localizer_.observe(
          CoarsePosition{frame.timestamp_s, found.position, found.sigma_m, found.heading_deg});
    }
    std::optional<FeatureSet> features;
    const QueryFrame query{frame.timestamp_s,
                           [&](const FeatureParameters& parameters) -> const FeatureSet& {
                             if (!features) features = FeatureExtractor(parameters).extract(gray);
                             return *features;
                           }};
    Result<Fix> fix = localizer_.localize(query);
    if (!fix) return fix.error();
    return FrameFix{frame.filename, std::move(*fix), ms_since(start), {}};
  }

 private:
  static LocalizerSettings settings() {
    LocalizerSettings settings;
    settings.method = *method_named(kDefaultMethod);
    return settings;
  }

  Localizer localizer_;
};

}  // namespace

Result<FoundDrive> find_drive(const Drive& drive, const std::vector<Wall>& walls,
                              const FindRun& run) {
  if (drive.odometry.empty()) {
    return Error{ErrorCode::invalid_input, (drive.folder / "odometry.csv").string(),
                 "there is nothing that says how the vehicle moved",
                 "add what its wheels said (timestamp_s,speed_mps,yaw_rate_dps)"};
  }
  const Camera& camera = drive.camera;
  Finder finder(
      walls, {camera.focal_x_px, camera.focal_y_px, camera.principal_x_px, camera.principal_y_px},
      run.finder);
  std::optional<Successor> successor;
  if (run.localizer_source) successor.emplace(run.localizer_source, camera);

  FoundDrive found;
  auto reading = drive.odometry.begin();
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    const Frame& frame = drive.frames[i];
    const Result<cv::Mat> gray = read_frame_gray(drive, i);
    if (!gray) return gray.error();
    for (; reading != drive.odometry.end() && reading->timestamp_s <= frame.timestamp_s;
         ++reading) {
      finder.observe({reading->timestamp_s, reading->speed_mps, reading->yaw_rate_dps});
      if (successor) successor->observe(*reading);
    }
    const auto start = SteadyClock::now();
    const FindFix fix = finder.find(*gray, frame.timestamp_s);
    found.frames.push_back({frame.filename, fix, ms_since(start)});
    if (successor) {
      Result<FrameFix> localized = successor->localize(frame, *gray, fix);
      if (!localized) return localized.error();
      found.localized.push_back(std::move(*localized));
    }
    if (!run.on_frame(i, fix, finder)) {
      return Error{ErrorCode::cancelled, drive.folder.string(),
                   "stopped on request, nothing was written", ""};
    }
  }
  return found;
}

}  // namespace milepost
