// Between the public face's values and the library's own.
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
#include "client/localize/tracked_position.h"
#include "schema/base/result.h"
#include "schema/geo/pinhole.h"

namespace milepost::vehicle {

Error error_of(const milepost::Error& error);

// From now on. A year at most: longer ones are as good as for ever, and cannot be counted.
std::chrono::steady_clock::time_point deadline_of(const Patience& patience);

// An error that is invalid_input.
Error wrong(const std::string& where, const std::string& what, const std::string& mend);

// Errors: invalid_input (not finite).
Status check_reading(const OdometryReading& reading);
// Errors: invalid_input (a value out of its range), unsupported (a lens with distortion).
Status check_camera(const Camera& camera);
milepost::Camera plain_camera_of(const Camera& camera);

// Errors: those of Localizer::open.
Result<std::shared_ptr<MapSource>> open_source(const Source& source);

// The vehicle's reference point, from where its camera is.
Pose vehicle_pose_of(const CameraPlacement& camera, const Mounting& mounting);

}  // namespace milepost::vehicle
