#include "client/face/conversions.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "client/fetch/file_source.h"
#include "client/fetch/http_source.h"
#include "schema/document/signing_key.h"
#include "schema/geo/camera.h"
#include "schema/geo/camera_pose.h"

namespace milepost::vehicle {
namespace {

ErrorCode code_of(milepost::ErrorCode code) {
  switch (code) {
    case milepost::ErrorCode::invalid_input:
      return ErrorCode::invalid_input;
    case milepost::ErrorCode::not_found:
      return ErrorCode::not_found;
    case milepost::ErrorCode::gone:
      return ErrorCode::gone;
    case milepost::ErrorCode::corrupt:
      return ErrorCode::corrupt;
    case milepost::ErrorCode::io:
      return ErrorCode::io;
    case milepost::ErrorCode::unavailable:
      return ErrorCode::unavailable;
    case milepost::ErrorCode::cancelled:
      break;
  }
  return ErrorCode::cancelled;
}

constexpr double kLongestS = 3600;  // of a timeout

bool is_above_zero(double value) { return std::isfinite(value) && value > 0; }

Result<std::shared_ptr<MapSource>> as_face(milepost::Result<std::shared_ptr<MapSource>> source) {
  if (!source) return error_of(source.error());
  return std::move(*source);
}

milepost::LensModel model_of(LensModel lens) {
  switch (lens) {
    case LensModel::brown_conrady:
      return milepost::LensModel::brown_conrady;
    case LensModel::kannala_brandt:
      return milepost::LensModel::kannala_brandt;
    case LensModel::pinhole:
      break;
  }
  return milepost::LensModel::pinhole;
}

milepost::Result<Lens> lens_of(const Camera& camera) {
  std::vector<double> coefficients = camera.distortion;
  const bool is_plain = std::ranges::all_of(coefficients, [](double k) { return k == 0; });
  if (camera.lens == LensModel::pinhole && is_plain) coefficients.clear();
  return Lens::make(model_of(camera.lens), coefficients);
}

milepost::Mounting mounting_of(const Mounting& m) {
  return {m.forward_m, m.right_m, m.up_m, m.yaw_deg, m.pitch_deg, m.roll_deg};
}

// Six degrees of freedom as a vector, in metres and radians of the tangent frame.
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

CameraPose pose_from(const Vector6& v) { return {v.head<3>(), v[3], v[4], v[5]}; }

Vector6 vector_from(const CameraPose& pose) {
  Vector6 v;
  v << pose.enu_m, pose.heading_rad, pose.pitch_rad, pose.roll_rad;
  return v;
}

}  // namespace

Error error_of(const milepost::Error& error) {
  return {code_of(error.code), error.where, error.what, error.hint};
}

std::chrono::steady_clock::time_point deadline_of(const Patience& patience) {
  constexpr std::chrono::hours kYear(24 * 365);
  return std::chrono::steady_clock::now() +
         std::min(patience.longest, std::chrono::milliseconds(kYear));
}

Error wrong(const std::string& where, const std::string& what, const std::string& hint) {
  return {ErrorCode::invalid_input, where, what, hint};
}

Status check_reading(const OdometryReading& reading) {
  const bool is_sound = std::isfinite(reading.timestamp_s) && std::isfinite(reading.speed_mps) &&
                        std::isfinite(reading.yaw_rate_dps);
  if (!is_sound) return wrong("odometry reading", "a value is not finite", "leave it out");
  return {};
}

Status check_camera(const Camera& camera) {
  if (camera.width_px < 1 || camera.height_px < 1) {
    return wrong("camera", "width_px and height_px are not both above 0",
                 "pass the size of its images");
  }
  if (!is_above_zero(camera.focal_x_px) || !is_above_zero(camera.focal_y_px)) {
    return wrong("camera", "focal_x_px and focal_y_px are not both above 0",
                 "calibrate the camera");
  }
  if (!std::isfinite(camera.principal_x_px) || !std::isfinite(camera.principal_y_px)) {
    return wrong("camera", "the principal point is not finite", "calibrate the camera");
  }
  const Mounting& m = camera.mounting;
  for (const double value : {m.forward_m, m.right_m, m.up_m, m.yaw_deg, m.pitch_deg, m.roll_deg}) {
    if (!std::isfinite(value)) return wrong("camera", "the mounting is not finite", "measure it");
  }
  const auto lens = lens_of(camera);
  if (!lens) return wrong("camera", lens.error().what, lens.error().hint);
  return {};
}

milepost::Camera plain_camera_of(const Camera& camera) {
  return {camera.width_px,
          camera.height_px,
          {camera.focal_x_px, camera.focal_y_px, camera.principal_x_px, camera.principal_y_px},
          *lens_of(camera),
          mounting_of(camera.mounting)};
}

Result<std::shared_ptr<MapSource>> open_source(const Source& source) {
  if (const auto* file = std::get_if<FileSource>(&source)) {
    return as_face(open_file_source(file->map_file));
  }
  const auto& server = std::get<ServerSource>(source);
  const bool is_sound = is_above_zero(server.connect_timeout_s) &&
                        is_above_zero(server.stall_timeout_s) &&
                        is_above_zero(server.least_bytes_per_s) &&
                        std::max(server.connect_timeout_s, server.stall_timeout_s) <= kLongestS;
  if (!is_sound) {
    return Error{ErrorCode::invalid_input, "source",
                 "a timeout or least_bytes_per_s is not above 0, or a timeout exceeds an hour",
                 "use the default values"};
  }
  HttpSourceSettings settings;
  settings.server_url = server.url;
  settings.cache_directory = server.cache_directory;
  settings.cache_limit_bytes = server.cache_limit_bytes;
  settings.connect_timeout_s = server.connect_timeout_s;
  settings.stall_timeout_s = server.stall_timeout_s;
  settings.least_bytes_per_s = server.least_bytes_per_s;
  settings.ca_file = server.ca_file;
  settings.token = server.token;
  for (const std::string& text : server.public_keys) {
    const milepost::Result<PublicKey> key = public_key_from(text);
    if (!key) return wrong("source", "public_keys: " + key.error().what, key.error().hint);
    settings.keys.push_back(*key);
  }
  return as_face(open_http_source(settings));
}

Pose vehicle_pose_of(const GeoCameraPose& camera, const Mounting& mounting) {
  const Eigen::Isometry3d camera_from_vehicle =
      vehicle_from_camera(mounting_of(mounting)).inverse();
  const auto vehicle_of = [&](const Vector6& camera_pose) {
    return vector_from(pose_of(enu_from_camera(pose_from(camera_pose)) * camera_from_vehicle));
  };
  const Vector6 at = vector_from({Eigen::Vector3d::Zero(), camera.heading_deg * kRadPerDeg,
                                  camera.pitch_deg * kRadPerDeg, camera.roll_deg * kRadPerDeg});
  const Vector6 vehicle = vehicle_of(at);
  Matrix6 derivative;
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const Vector6 step = kStep * Vector6::Unit(i);
    Vector6 change = vehicle_of(at + step) - vehicle_of(at - step);
    // Headings wrap around at south.
    for (int angle = 3; angle < 6; ++angle) {
      change[angle] = std::remainder(change[angle], 2 * std::numbers::pi);
    }
    derivative.col(i) = change / (2 * kStep);
  }
  // In metres and degrees, like the covariances.
  derivative.topRightCorner<3, 3>() *= kRadPerDeg;
  derivative.bottomLeftCorner<3, 3>() /= kRadPerDeg;
  const LocalFrame frame(camera.position);
  const GeoPoint position = frame.geo_from_enu({vehicle[0], vehicle[1], vehicle[2]});
  Pose pose;
  pose.latitude_deg = position.latitude_deg;
  pose.longitude_deg = position.longitude_deg;
  pose.altitude_m = position.altitude_m;
  pose.heading_deg = wrapped_360(vehicle[3] / kRadPerDeg);
  pose.pitch_deg = vehicle[4] / kRadPerDeg;
  pose.roll_deg = vehicle[5] / kRadPerDeg;
  const Eigen::Map<const Matrix6> of_camera(camera.covariance.data());
  Eigen::Map<Matrix6>(pose.covariance.data()) = derivative * of_camera * derivative.transpose();
  return pose;
}

}  // namespace milepost::vehicle
