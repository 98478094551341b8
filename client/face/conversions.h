// Conversions between the types of the public interface and the internal ones.
#pragma once

#include <milepost/camera.h>
#include <milepost/patience.h>
#include <milepost/pose.h>
#include <milepost/readings.h>
#include <milepost/result.h>
#include <milepost/source.h>

#include <chrono>
#include <memory>

#include "client/fetch/map_source.h"
#include "client/localize/tracked_pose.h"
#include "schema/base/result.h"
#include "schema/geo/camera.h"

namespace milepost::vehicle {

Error error_of(const milepost::Error& error);

// The time at which the patience ends, limited to a year from now to avoid overflow.
std::chrono::steady_clock::time_point deadline_of(const Patience& patience);

// An error with the code invalid_input.
Error wrong(const std::string& where, const std::string& what, const std::string& hint);

// Errors: invalid_input (not finite).
Status check_reading(const OdometryReading& reading);
// Errors: invalid_input (a value out of range, a lens that is none).
Status check_camera(const Camera& camera);
milepost::Camera plain_camera_of(const Camera& camera);

// Errors: those of Localizer::open.
Result<std::shared_ptr<MapSource>> open_source(const Source& source);

// The pose of the vehicle's reference point from that of its camera, with the covariance propagated
// by the Jacobian.
Pose vehicle_pose_of(const GeoCameraPose& camera, const Mounting& mounting);

}  // namespace milepost::vehicle
