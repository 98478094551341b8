// What a consumer receiver and the wheels say of a motion, and what a camera's sensor adds.
#pragma once

#include <functional>
#include <vector>

#include "schema/drive/drive.h"
#include "tests/simulator/motion.h"
#include "tests/simulator/scene.h"
#include "tests/simulator/shadow.h"

namespace milepost::simulator {

// Where the town's local frame lies on the Earth.
inline constexpr GeoPoint kOrigin{49.0, 8.4, 110.0};

GeoPoint geo_from_point(const Point& point);

// The standard deviation (of the distance, over both axes) that a receiver states where it sees
// this share of the sky: signals are blocked and reflected between tall houses.
double receiver_sigma_m(double open_share);

// One fix a second. Errors come and go over half a minute, are larger where less of the sky is
// seen, and there lean across the street for as long as the street lasts.
std::vector<GpsFix> receive(const Motion& motion, const SkyView& sky_view, cv::RNG& random);

// Ten readings a second, with noise, an error of scale and a drift of the yaw rate.
std::vector<Odometry> measure_wheels(const Motion& motion, cv::RNG& random);

// What the camera makes of a picture: automatic exposure, then noise of the given standard
// deviation in grey levels.
cv::Mat sensed(const cv::Mat& picture, double noise, cv::RNG& random);

double to_milliseconds(double time_s);

}  // namespace milepost::simulator
