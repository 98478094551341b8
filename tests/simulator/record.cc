#include "tests/simulator/record.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <system_error>

#include <opencv2/imgcodecs.hpp>

#include "tests/simulator/render.h"

namespace milepost::simulator {
namespace fs = std::filesystem;
namespace {

constexpr double kCameraHeightM = 1.5;
constexpr double kDegPerRad = 180 / std::numbers::pi;
constexpr double kWanderPeriodM = 70;
constexpr GeoPoint kOrigin{49.0, 8.4, 110.0};
constexpr int kJpegQuality = 93;

// The standard deviation a receiver states, spread over two axes; its error comes and goes with
// the constellation, over about half a minute.
constexpr double kGpsSigmaM = 5;
constexpr double kGpsPeriodS = 1;
constexpr double kGpsMemoryS = 30;

constexpr double kOdometerPeriodS = 0.1;
constexpr double kSpeedNoiseMps = 0.05;
constexpr double kYawRateNoiseDps = 0.3;

double to_milliseconds(double time_s) { return std::round(time_s * 1000) / 1000; }

// The line a run drives, without jitter.
class Path {
 public:
  Path(const Street& street, const RunPlan& run) : line_(street.line), run_(run) {}

  double along_m(double time_s) const {
    return run_.from_m + (time_s - run_.start_s) * run_.speed_mps;
  }
  Point position(double along_m) const {
    const cv::Vec2d plane = line_.position_at({along_m, lateral_m(along_m)});
    return {plane[0], plane[1], kCameraHeightM};
  }
  double heading_deg(double along_m) const {
    constexpr double kHalfStepM = 0.05;
    const Point step = position(along_m + kHalfStepM) - position(along_m - kHalfStepM);
    return std::atan2(step[0], step[1]) * kDegPerRad;
  }

 private:
  double lateral_m(double along_m) const {
    const double angle = 2 * std::numbers::pi * along_m / kWanderPeriodM;
    return run_.lateral_m + run_.wander_m * std::sin(angle + static_cast<double>(run_.seed));
  }

  const Centreline& line_;
  const RunPlan& run_;
};

GeoPoint geo_from_point(const Point& point) {
  return LocalFrame(kOrigin).geo_from_enu({point[0], point[1], point[2]});
}

cv::Mat with_sensor(const cv::Mat& picture, const RunPlan& run, cv::RNG& random) {
  cv::Mat noise(picture.size(), CV_32FC3);
  random.fill(noise, cv::RNG::NORMAL, 0, run.image_noise);
  cv::Mat bright;
  picture.convertTo(bright, CV_32FC3, run.gain);
  bright += noise;
  cv::Mat result;
  bright.convertTo(result, CV_8UC3);
  return result;
}

std::size_t frame_count(const RunPlan& run) {
  return static_cast<std::size_t>(std::ceil((run.to_m - run.from_m) / run.spacing_m - 1e-9));
}

std::string frame_name(std::size_t index) {
  char name[32];
  std::snprintf(name, sizeof name, "%06zu.jpg", index);
  return name;
}

Status write_image(const fs::path& path, const cv::Mat& image) {
  try {
    if (cv::imwrite(path.string(), image, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality})) {
      return ok_status();
    }
  } catch (const cv::Exception&) {  // falls through to the error
  }
  return Error{ErrorCode::io, path.string(), "cannot be written",
               "check the disk's space and the permissions"};
}

// Renders and writes the frames; notes them in `drive`.
Status record_frames(const Street& street, const RunPlan& run, const Path& path,
                     const fs::path& folder, const Progress& progress, Drive& drive) {
  cv::RNG random(run.seed);
  const std::size_t count = frame_count(run);
  for (std::size_t i = 0; i < count; ++i) {
    if (progress) progress(i, count);
    const double time_s =
        to_milliseconds(run.start_s + static_cast<double>(i) * run.spacing_m / run.speed_mps);
    const double along_m = path.along_m(time_s);
    const Pose pose{path.position(along_m),
                    path.heading_deg(along_m) + random.gaussian(run.heading_jitter_deg),
                    random.gaussian(run.pitch_jitter_deg)};
    const cv::Mat picture = with_sensor(render(street.scene, run.camera, pose), run, random);
    Frame frame{frame_name(i), time_s, geo_from_point(pose.position),
                wrapped_360(pose.heading_deg)};
    Status status = write_image(folder / drive.images / frame.filename, picture);
    if (!status) return status;
    drive.frames.push_back(std::move(frame));
  }
  return ok_status();
}

// A first order Gauss-Markov process: unit variance, forgotten with kGpsMemoryS.
double next_error(double error, cv::RNG& random) {
  const double kept = std::exp(-kGpsPeriodS / kGpsMemoryS);
  return error * kept + random.gaussian(std::sqrt(1 - kept * kept));
}

std::vector<GpsFix> receive(const Path& path, double from_s, double to_s, cv::RNG& random) {
  std::vector<GpsFix> fixes;
  double east_error = random.gaussian(1);
  double north_error = random.gaussian(1);
  for (double time_s = from_s; time_s <= to_s; time_s += kGpsPeriodS) {
    const double axis_sigma_m = kGpsSigmaM / std::numbers::sqrt2;
    const Point error = Point(east_error, north_error, 0) * axis_sigma_m;
    GpsFix fix{to_milliseconds(time_s), geo_from_point(path.position(path.along_m(time_s)) + error),
               kGpsSigmaM};
    fix.position.altitude_m = 0;
    fixes.push_back(fix);
    east_error = next_error(east_error, random);
    north_error = next_error(north_error, random);
  }
  return fixes;
}

std::vector<OdometryReading> measure_wheels(const Path& path, const RunPlan& run, double from_s,
                                            double to_s, cv::RNG& random) {
  std::vector<OdometryReading> readings;
  for (double time_s = from_s; time_s <= to_s; time_s += kOdometerPeriodS) {
    const double turned_deg = std::remainder(path.heading_deg(path.along_m(time_s + 0.05)) -
                                                 path.heading_deg(path.along_m(time_s - 0.05)),
                                             360);
    readings.push_back({to_milliseconds(time_s), run.speed_mps + random.gaussian(kSpeedNoiseMps),
                        turned_deg / 0.1 + random.gaussian(kYawRateNoiseDps)});
  }
  return readings;
}

Status check_run(const RunPlan& run) {
  const bool is_drive = run.spacing_m > 0 && run.speed_mps > 0 && run.to_m > run.from_m;
  if (is_drive) return ok_status();
  return Error{ErrorCode::invalid_input, run.name, "the run has no way, spacing or speed above 0",
               "correct the run"};
}

}  // namespace

RunPlan map_run(const StreetPlan& plan) {
  RunPlan run;
  run.name = "street-map";
  run.to_m = plan.length_m;
  run.seed = plan.seed * 2 + 1;
  return run;
}

RunPlan query_run(const StreetPlan& plan) {
  RunPlan run;
  run.name = "street-query";
  run.from_m = std::min(1.0, plan.length_m / 2);
  run.to_m = plan.length_m;
  run.spacing_m = 1.7;
  run.speed_mps = 8.5;
  run.start_s = 1000;
  run.lateral_m = 1.75 + 0.3;
  run.wander_m = 0.25;
  run.heading_jitter_deg = 0.4;
  run.pitch_jitter_deg = 0.2;
  run.gain = 0.92;
  run.image_noise = 3;
  run.has_receiver = true;
  run.has_odometer = true;
  run.seed = plan.seed * 2 + 2;
  return run;
}

Status record(const Street& street, const RunPlan& run, const fs::path& folder,
              const Progress& progress) {
  if (Status status = check_run(run); !status) return status;
  Drive drive;
  drive.name = run.name;
  drive.camera = run.camera;
  drive.position_frame = PositionFrame::local;
  drive.origin = kOrigin;
  drive.images = "frames";
  drive.captured = "simulated";
  drive.licence = "as the project";
  drive.source = "milepost-simulator, street of seed " + std::to_string(street.plan.seed);
  std::error_code error;
  fs::create_directories(folder / drive.images, error);
  if (error) {
    return Error{ErrorCode::io, (folder / drive.images).string(),
                 "cannot be made (" + error.message() + ")", "check the path and the permissions"};
  }
  const Path path(street, run);
  Status status = record_frames(street, run, path, folder, progress, drive);
  if (!status) return status;
  const double to_s = drive.frames.back().timestamp_s;
  cv::RNG random(~run.seed);  // apart from the images' noise
  if (run.has_receiver) drive.gps = receive(path, run.start_s, to_s, random);
  if (run.has_odometer) drive.odometry = measure_wheels(path, run, run.start_s, to_s, random);
  return write_drive(drive, folder);
}

}  // namespace milepost::simulator
