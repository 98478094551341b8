#include "tests/simulator/record.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <sstream>
#include <system_error>

#include <opencv2/imgcodecs.hpp>

#include "schema/base/digest.h"
#include "tests/simulator/kept_frames.h"
#include "tests/simulator/lane_columns.h"
#include "tests/simulator/lens_view.h"
#include "tests/simulator/paint.h"
#include "tests/simulator/parallel.h"
#include "tests/simulator/position_errors.h"
#include "tests/simulator/sensors.h"
#include "tests/simulator/traffic.h"

namespace milepost::simulator {
namespace fs = std::filesystem;
namespace {

constexpr double kCameraHeightM = 1.5;
constexpr int kJpegQuality = 93;
constexpr const char* kImages = "frames";
constexpr std::uint64_t kDrawing = 1;    // to be raised when the same plan gives other pictures
constexpr double kPositionMemoryM = 15;  // correlation length of position noise

// The data of a frame except its picture.
struct Shot {
  double time_s = 0;
  double along_m = 0;
  Pose pose;                 // of the vehicle's reference point
  Pose camera;               // the same, if it is not mounted elsewhere
  cv::Vec2d position_error;  // of the written position
  PoseError error;           // a further one
  std::uint64_t seed = 0;    // of the picture's noise
};

std::vector<double> frame_times(const Motion& motion, const RunPlan& run, cv::RNG& random) {
  std::vector<double> times;
  if (run.spacing_m > 0) {
    for (double along = run.motion.from_m; along < run.motion.to_m; along += run.spacing_m) {
      times.push_back(to_milliseconds(motion.time_s_at(along)));
    }
    return times;
  }
  for (double time = motion.start_s(); time < motion.end_s(); time += run.frame_period_s) {
    const double late_s = std::clamp(random.gaussian(run.period_jitter_s), -run.frame_period_s / 3,
                                     run.frame_period_s / 3);
    const bool is_dropped = random.uniform(0.0, 1.0) < run.dropped_share;
    if (!is_dropped || times.empty()) {
      times.push_back(to_milliseconds(std::max(time + late_s, motion.start_s())));
    }
  }
  return times;
}

// A pose moved by a transform of its own frame.
Pose moved(const Pose& from, const Eigen::Isometry3d& from_to) {
  const CameraPose pose = {{from.position[0], from.position[1], from.position[2]},
                           from.heading_deg * kRadPerDeg,
                           from.pitch_deg * kRadPerDeg,
                           from.roll_deg * kRadPerDeg};
  const CameraPose to = pose_of(enu_from_camera(pose) * from_to);
  return {{to.enu_m.x(), to.enu_m.y(), to.enu_m.z()},
          to.heading_rad * kDegPerRad,
          to.pitch_rad * kDegPerRad,
          to.roll_rad * kDegPerRad};
}

// Of the vehicle's reference point, which is where the camera is if it is not mounted elsewhere.
Pose pose_at(const Network& network, const Motion& motion, const RunPlan& run, double along_m,
             cv::RNG& random) {
  constexpr double kHalfBaseM = 1.3;
  const Route& route = *network.route(run.route);
  const auto height = [&](double at_m) {
    return route.height_m(network.terrain, at_m, motion.position_at(at_m));
  };
  const cv::Vec2d plane = motion.position_at(along_m);
  const double rise = height(along_m + kHalfBaseM) - height(along_m - kHalfBaseM);
  Pose pose;
  pose.position = {plane[0], plane[1], height(along_m) + kCameraHeightM};
  pose.heading_deg =
      motion.heading_rad_at(along_m) * kDegPerRad + random.gaussian(run.heading_jitter_deg);
  pose.pitch_deg =
      std::atan2(rise, 2 * kHalfBaseM) * kDegPerRad + random.gaussian(run.pitch_jitter_deg);
  pose.roll_deg = random.gaussian(run.roll_jitter_deg);
  return pose;
}

std::vector<Shot> plan_shots(const Network& network, const Motion& motion, const RunPlan& run) {
  cv::RNG random = seeded(run.seed);
  std::vector<Shot> shots;
  cv::Vec2d error(random.gaussian(1), random.gaussian(1));
  double last_m = run.motion.from_m;
  for (const double time : frame_times(motion, run, random)) {
    Shot shot;
    shot.time_s = time;
    shot.along_m = motion.along_m_at(time);
    shot.pose = pose_at(network, motion, run, shot.along_m, random);
    shot.camera = run.camera.mounting.is_at_reference_point()
                      ? shot.pose
                      : moved(shot.pose, vehicle_from_camera(run.camera.mounting));
    const double kept = std::exp(-(shot.along_m - last_m) / kPositionMemoryM);
    last_m = shot.along_m;
    for (int i = 0; i < 2; ++i) {
      error[i] = error[i] * kept + random.gaussian(std::sqrt(1 - kept * kept));
    }
    shot.position_error = error * run.position_noise_m;
    shot.seed = random.next();
    shots.push_back(shot);
  }
  std::vector<double> alongs_m(shots.size());
  for (std::size_t i = 0; i < shots.size(); ++i) alongs_m[i] = shots[i].along_m;
  const std::vector<PoseError> errors = draw_errors(run.errors, alongs_m, run.seed);
  for (std::size_t i = 0; i < shots.size(); ++i) shots[i].error = errors[i];
  return shots;
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

Status check_run(const Town& town, const RunPlan& run) {
  if (town.network.route(run.route) == nullptr) {
    return Error{ErrorCode::invalid_input, run.name, "there is no route " + run.route,
                 "choose a route of the town"};
  }
  const bool has_frames = run.spacing_m > 0 || (run.spacing_m == 0 && run.frame_period_s > 0);
  if (has_frames && run.motion.cruise_mps > 0 && run.motion.to_m > run.motion.from_m) {
    return ok_status();
  }
  return Error{ErrorCode::invalid_input, run.name, "the run has no way, spacing or speed above 0",
               "correct the run"};
}

Motion motion_of(const Town& town, const RunPlan& run) {
  return {path_of(town.network, run), town.network.route(run.route)->lane_m, run.motion};
}

std::vector<fs::path> frame_files(const std::vector<Shot>& shots) {
  std::vector<fs::path> files;
  for (std::size_t i = 0; i < shots.size(); ++i) files.push_back(fs::path(kImages) / frame_name(i));
  return files;
}

// Of all that the frames depend on.
std::string digest_of_frames(const Town& town, const RunPlan& run, const std::vector<Shot>& shots) {
  std::ostringstream fields;
  fields.precision(17);
  const auto add = [&fields](const auto& field) { fields << field << '\n'; };
  add(kDrawing);
  add(town.kind);
  add(town.seed);
  add(town.scene.surfaces.size());
  add(run.name);
  add(run.seed);
  add((run.has_truck_ahead ? 2 : 0) + (run.has_oncoming ? 1 : 0));
  add(run.camera.width_px);
  add(run.camera.height_px);
  const Pinhole& pinhole = run.camera.pinhole;
  for (const double value :
       {pinhole.focal_x_px, pinhole.focal_y_px, pinhole.principal_x_px, pinhole.principal_y_px,
        run.image_noise, run.motion.from_m, run.motion.to_m, run.light.sun_azimuth_deg,
        run.light.sun_elevation_deg}) {
    add(value);
  }
  if (!run.camera.lens.is_pinhole()) {
    add(name_of(run.camera.lens.model()));
    for (const double coefficient : run.camera.lens.coefficients()) add(coefficient);
  }
  for (const Shot& shot : shots) {
    const Pose& pose = shot.camera;
    for (const double value : {shot.time_s, shot.along_m, pose.position[0], pose.position[1],
                               pose.position[2], pose.heading_deg, pose.pitch_deg, pose.roll_deg}) {
      add(value);
    }
  }
  return digest_of(as_bytes(fields.str()));
}

Drive described(const Town& town, const RunPlan& run) {
  Drive drive;
  drive.name = run.name;
  drive.camera = run.camera;
  drive.position_frame = PositionFrame::local;
  drive.origin = kOrigin;
  drive.images = kImages;
  drive.captured = "simulated";
  drive.licence = "Apache-2.0";
  drive.source = "milepost-simulator, " + town.kind + " of seed " + std::to_string(town.seed) +
                 ": " + run.says;
  return drive;
}

// As the reader of the drive makes it, for the writer to write what was recorded.
Frame frame_of(const std::string& filename, double time_s, GeoAttitude vehicle,
               const Drive& drive) {
  if (!drive.has_tilts) vehicle.pitch_deg = vehicle.roll_deg = 0;
  const GeoAttitude camera = camera_of_vehicle(vehicle, drive.camera.mounting);
  return {filename, time_s, camera.position, camera.heading_deg, camera.pitch_deg, camera.roll_deg};
}

Status write_tables(const Town& town, const RunPlan& run, const Motion& motion,
                    const std::vector<Shot>& shots, const fs::path& folder) {
  Drive drive = described(town, run);
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const Shot& shot = shots[i];
    const Point written = shot.pose.position +
                          Point(shot.position_error[0], shot.position_error[1], 0) +
                          shot.error.position;
    const GeoAttitude vehicle{geo_from_point(written),
                              wrapped_360(shot.pose.heading_deg + shot.error.heading_deg),
                              shot.pose.pitch_deg, shot.pose.roll_deg};
    drive.has_tilts = run.records_tilts;
    drive.frames.push_back(frame_of(frame_name(i), shot.time_s, vehicle, drive));
  }
  cv::RNG random = seeded(~run.seed);  // independent of the pictures' noise
  if (run.has_receiver) drive.gps = receive(motion, *town.sky_view, random);
  if (run.has_odometer) drive.odometry = measure_wheels(motion, random);
  const Status status = write_drive(drive, folder);
  if (!status || !run.states_lanes) return status;
  const Route& route = *town.network.route(run.route);
  std::vector<std::string> lanes;
  for (const Shot& shot : shots) {
    const RouteSpan& span = route.span_at(shot.along_m);
    lanes.push_back(span.road + "," + std::to_string(span.lane));
  }
  return add_columns(folder / "trajectory.csv", "road,lane", lanes);
}

}  // namespace

bool has_recorded(const Town& town, const RunPlan& run, const fs::path& folder) {
  if (!run.keeps_frames || !check_run(town, run)) return false;
  const std::vector<Shot> shots = plan_shots(town.network, motion_of(town, run), run);
  return has_frames(folder, digest_of_frames(town, run, shots), frame_files(shots));
}

Status record_tables(const Town& town, const RunPlan& run, const fs::path& folder) {
  if (Status status = check_run(town, run); !status) return status;
  const Motion motion = motion_of(town, run);
  return write_tables(town, run, motion, plan_shots(town.network, motion, run), folder);
}

Status record(const Town& town, const Lighting& lighting, const RunPlan& run,
              const fs::path& folder, int threads, const Progress& progress) {
  if (Status status = check_run(town, run); !status) return status;
  const fs::path images = folder / kImages;
  std::error_code error;
  fs::create_directories(images, error);
  if (error) {
    return Error{ErrorCode::io, images.string(), "cannot be created (" + error.message() + ")",
                 "check the path and the permissions"};
  }
  const Motion motion = motion_of(town, run);
  const Traffic traffic(town.network, run);
  const std::vector<Shot> shots = plan_shots(town.network, motion, run);
  const LensView lens(run.camera);
  if (Status status = forget_frames(folder); !status) return status;
  Status status = for_each_in_parallel(shots.size(), threads, progress, [&](std::size_t i) {
    const Shot& shot = shots[i];
    cv::RNG random = seeded(shot.seed);
    const cv::Mat picture = lens.shown(render(town.scene, lighting, lens.pinhole(), shot.camera,
                                              traffic.at(shot.time_s, shot.along_m)));
    return write_image(images / frame_name(i), sensed(picture, run.image_noise, random));
  });
  if (status && run.keeps_frames) {
    status = note_frames(folder, digest_of_frames(town, run, shots));
  }
  return status ? write_tables(town, run, motion, shots, folder) : status;
}

}  // namespace milepost::simulator
