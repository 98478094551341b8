#include "schema/drive/checks.h"

#include <cmath>
#include <filesystem>
#include <string_view>
#include <unordered_map>

#include "schema/base/digits.h"
#include "schema/base/median.h"

namespace milepost {
namespace {

constexpr int kMaxImageSidePx = 20000;

Error invalid(std::string where, std::string what, std::string hint) {
  return {ErrorCode::invalid_input, std::move(where), std::move(what), std::move(hint)};
}

Status check_side(int side_px, const char* key, const std::string& where) {
  if (side_px >= 1 && side_px <= kMaxImageSidePx) return ok_status();
  return invalid(where, std::string("camera.") + key + " is " + std::to_string(side_px),
                 "give the images' size, 1 to " + std::to_string(kMaxImageSidePx) + " pixels");
}

Status check_time(double timestamp_s, const double* previous_s, const RowPlaces& rows,
                  std::size_t row) {
  if (!std::isfinite(timestamp_s)) {
    return invalid(rows.place(row), "timestamp_s is not a finite number",
                   "correct or remove the row");
  }
  if (previous_s == nullptr || timestamp_s > *previous_s) return ok_status();
  return invalid(rows.place(row),
                 "timestamp_s " + shortest(timestamp_s) + " is not later than " +
                     shortest(*previous_s) + " on line " + std::to_string(rows.lines[row - 1]),
                 "sort the rows by time, without repeated times");
}

// Recorders that write ms, us or ns look like very slow ones.
Status check_unit_of_time(std::vector<double> intervals_s, const std::string& file) {
  constexpr std::size_t kFewest = 4;
  constexpr double kSlowestS = 30;
  if (intervals_s.size() < kFewest) return ok_status();
  const double median_s = median_of(std::move(intervals_s));
  if (median_s < kSlowestS) return ok_status();
  const char* unit = median_s < 1000 * kSlowestS  ? "milliseconds"
                     : median_s < 1e6 * kSlowestS ? "microseconds"
                                                  : "nanoseconds";
  return invalid(file,
                 "rows lie " + fixed(median_s, 0) + " s apart (median), as of times in " + unit,
                 "give timestamp_s in seconds");
}

// The error of the first row of `readings` with an invalid time, or of all times, or ok.
template <class Reading>
Status check_times(const std::vector<Reading>& readings, const RowPlaces& rows) {
  for (std::size_t row = 0; row < readings.size(); ++row) {
    const double* previous_s = row == 0 ? nullptr : &readings[row - 1].timestamp_s;
    Status status = check_time(readings[row].timestamp_s, previous_s, rows, row);
    if (!status) return status;
  }
  std::vector<double> intervals_s;
  for (std::size_t row = 1; row < readings.size(); ++row)
    intervals_s.push_back(readings[row].timestamp_s - readings[row - 1].timestamp_s);
  return check_unit_of_time(std::move(intervals_s), rows.file);
}

// Whether `name` is a file name without path that an unquoted table can hold.
bool is_plain_filename(std::string_view name) {
  return !name.empty() && name != "." && name != ".." &&
         name.find_first_of(std::string_view("/\\,\r\n\0", 6)) == std::string_view::npos;
}

Status check_filenames(const std::vector<Frame>& frames, const RowPlaces& rows) {
  std::unordered_map<std::string_view, std::size_t> row_of;
  for (std::size_t row = 0; row < frames.size(); ++row) {
    const std::string& name = frames[row].filename;
    if (!is_plain_filename(name)) {
      return invalid(rows.place(row), "filename '" + name + "' is not the plain name of a file",
                     "name an image inside the images folder, without any path");
    }
    const auto [first, is_new] = row_of.emplace(name, row);
    if (!is_new) {
      return invalid(
          rows.place(row),
          "filename '" + name + "' is already on line " + std::to_string(rows.lines[first->second]),
          "give each frame an image of its own");
    }
  }
  return ok_status();
}

Status check_position(const GeoPoint& position, const std::string& place) {
  if (!(std::abs(position.latitude_deg) <= 90)) {
    return invalid(place, "latitude_deg " + shortest(position.latitude_deg) + " is out of range",
                   "give a latitude from -90 to 90 degrees");
  }
  if (!(std::abs(position.longitude_deg) <= 180)) {
    return invalid(place, "longitude_deg " + shortest(position.longitude_deg) + " is out of range",
                   "give a longitude from -180 to 180 degrees");
  }
  if (!std::isfinite(position.altitude_m)) {
    return invalid(place, "the altitude is not a finite number", "correct or remove the row");
  }
  return ok_status();
}

bool is_position_sigma(double sigma_m) { return sigma_m >= 0 && sigma_m <= 1000; }

// REQUIRES: both rows' times and positions are checked.
Status check_jump(const std::vector<Frame>& frames, const RowPlaces& rows, std::size_t row) {
  const Frame& from = frames[row - 1];
  const Frame& to = frames[row];
  const double distance_m = std::hypot(geodesic_distance_m(from.position, to.position),
                                       to.position.altitude_m - from.position.altitude_m);
  const double elapsed_s = to.timestamp_s - from.timestamp_s;
  const double speed_mps = distance_m / elapsed_s;
  if (speed_mps <= kMaxSpeedMps) return ok_status();
  return invalid(rows.place(row),
                 "the position jumps " + fixed(distance_m, 1) + " m from line " +
                     std::to_string(rows.lines[row - 1]) + " in " + fixed(elapsed_s, 3) +
                     " s: " + fixed(speed_mps, 1) + " m/s, faster than " + fixed(kMaxSpeedMps, 0),
                 "correct the positions or the times, or split the drive there");
}

Status check_mounting(const Mounting& mounting, const std::string& where) {
  constexpr double kMaxLeverM = 50;
  for (const auto& [name, metres] : {std::pair{"forward_m", mounting.forward_m},
                                     {"right_m", mounting.right_m},
                                     {"up_m", mounting.up_m}}) {
    if (std::abs(metres) <= kMaxLeverM) continue;
    return invalid(where, std::string("mounting.") + name + " is " + shortest(metres),
                   "give metres from the vehicle's reference point to its camera, -50 to 50");
  }
  for (const auto& [name, degrees, most_deg] : {std::tuple{"yaw_deg", mounting.yaw_deg, 180.0},
                                                {"pitch_deg", mounting.pitch_deg, 80.0},
                                                {"roll_deg", mounting.roll_deg, 180.0}}) {
    if (std::abs(degrees) <= most_deg) continue;
    return invalid(where, std::string("mounting.") + name + " is " + shortest(degrees),
                   "give degrees within " + shortest(most_deg));
  }
  return ok_status();
}

}  // namespace

Status check_camera(const Camera& camera, const std::string& where) {
  if (Status status = check_side(camera.width_px, "width_px", where); !status) return status;
  if (Status status = check_side(camera.height_px, "height_px", where); !status) return status;
  for (const double focal_px : {camera.pinhole.focal_x_px, camera.pinhole.focal_y_px}) {
    if (!(std::isfinite(focal_px) && focal_px > 0)) {
      return invalid(where, "camera.focal_px holds " + shortest(focal_px),
                     "give two focal lengths above 0, in pixels");
    }
  }
  if (!std::isfinite(camera.pinhole.principal_x_px) ||
      !std::isfinite(camera.pinhole.principal_y_px)) {
    return invalid(where, "camera.principal_px is not finite",
                   "give the image's centre, in pixels");
  }
  return check_mounting(camera.mounting, where);
}

Status check_images_folder(const std::string& images, const std::string& where) {
  const std::filesystem::path path(images);
  bool inside = !path.empty() && path.is_relative();
  for (const auto& part : path) inside = inside && part != "..";
  if (inside) return ok_status();
  return invalid(where, "images is '" + images + "', not a folder inside the drive",
                 "name the folder of the frames relative to the drive, for example frames");
}

Status check_position_error(const StatedPositionError& error, const std::string& where) {
  if (error.sigma_m && !is_position_sigma(*error.sigma_m)) {
    return invalid(where, "position_sigma_m is " + shortest(*error.sigma_m),
                   "give the standard deviation of the positions on each axis, 0 to 1000 metres");
  }
  constexpr double kMaxCorrelationM = 1e5;
  if (error.correlation_m &&
      !(*error.correlation_m >= 1 && *error.correlation_m <= kMaxCorrelationM)) {
    return invalid(where, "position_correlation_m is " + shortest(*error.correlation_m),
                   "give the length over which errors stay alike, 1 to 100000 metres");
  }
  return ok_status();
}

Status check_frames(const std::vector<Frame>& frames, const RowPlaces& rows) {
  if (frames.empty()) {
    return invalid(rows.file, "there is no frame", "give the table one row for each image");
  }
  if (Status status = check_filenames(frames, rows); !status) return status;
  if (Status status = check_times(frames, rows); !status) return status;
  for (std::size_t row = 0; row < frames.size(); ++row) {
    if (!(std::abs(frames[row].pitch_deg) <= 80 && std::abs(frames[row].roll_deg) <= 180)) {
      return invalid(rows.place(row), "pitch_deg or roll_deg is out of range",
                     "give degrees: pitch upwards, -80 to 80, and roll, -180 to 180");
    }
    if (!std::isfinite(frames[row].heading_deg)) {
      return invalid(rows.place(row), "heading_deg is not a finite number",
                     "correct or remove the row");
    }
    const std::optional<double>& sigma_m = frames[row].position_sigma_m;
    if (sigma_m && !is_position_sigma(*sigma_m)) {
      return invalid(rows.place(row), "position_sigma_m is " + shortest(*sigma_m),
                     "give the standard deviation of the position on each axis, 0 to 1000 metres");
    }
    Status status = check_position(frames[row].position, rows.place(row));
    if (status && row > 0) status = check_jump(frames, rows, row);
    if (!status) return status;
  }
  return ok_status();
}

Status check_gps(const std::vector<GpsFix>& gps, const RowPlaces& rows) {
  if (Status status = check_times(gps, rows); !status) return status;
  for (std::size_t row = 0; row < gps.size(); ++row) {
    Status status = check_position(gps[row].position, rows.place(row));
    if (!status) return status;
    if (!(std::isfinite(gps[row].sigma_m) && gps[row].sigma_m > 0)) {
      return invalid(rows.place(row), "sigma_m is " + shortest(gps[row].sigma_m),
                     "give a standard deviation above 0, in metres");
    }
  }
  return ok_status();
}

Status check_odometry(const std::vector<Odometry>& odometry, const RowPlaces& rows) {
  if (Status status = check_times(odometry, rows); !status) return status;
  for (std::size_t row = 0; row < odometry.size(); ++row) {
    if (!std::isfinite(odometry[row].speed_mps) || !std::isfinite(odometry[row].yaw_rate_dps)) {
      return invalid(rows.place(row), "speed_mps or yaw_rate_dps is not a finite number",
                     "correct or remove the row");
    }
  }
  return ok_status();
}

}  // namespace milepost
