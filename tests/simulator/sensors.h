// Sensor models: a consumer GNSS receiver, wheel odometry, and a camera's sensor.
#pragma once

#include <functional>
#include <vector>

#include "schema/drive/drive.h"
#include "tests/simulator/motion.h"
#include "tests/simulator/scene.h"
#include "tests/simulator/shadow.h"

namespace milepost::simulator {

// The origin of the town's local frame on the Earth.
inline constexpr GeoPoint kOrigin{49.0, 8.4, 110.0};

GeoPoint geo_from_point(const Point& point);

// The standard deviation (of the distance, over both axes) that a receiver reports at this share of
// open sky: signals are blocked and reflected between tall houses.
double receiver_sigma_m(double open_share);

// One fix per second. Errors are correlated over half a minute, and larger with less open sky,
// where they also have a lateral bias that is constant along a street.
std::vector<GpsFix> receive(const Motion& motion, const SkyView& sky_view, cv::RNG& random);

// Wheel odometry: ten readings per second, with noise, a scale error and a drift of the yaw rate.
std::vector<Odometry> measure_wheels(const Motion& motion, cv::RNG& random);

// The camera's sensor: automatic exposure, then noise of the given standard deviation in grey
// levels.
cv::Mat sensed(const cv::Mat& picture, double noise, cv::RNG& random);

double to_milliseconds(double time_s);

}  // namespace milepost::simulator
