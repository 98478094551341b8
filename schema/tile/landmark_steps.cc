#include "schema/tile/landmark_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace milepost {
namespace {

constexpr double kCentimetresAMetre = 100;
constexpr double kDecimetresAMetre = 10;
constexpr double kLongestM = 100;     // largest size and depth sigma
constexpr double kLengthStep = 1.05;  // ratio of successive sizes and depth sigmas

template <class Number>
Number nearest(double steps) {
  using Limits = std::numeric_limits<Number>;
  return static_cast<Number>(std::clamp<double>(std::round(steps), Limits::min(), Limits::max()));
}

std::uint8_t length_steps(double length_m) {
  return nearest<std::uint8_t>(std::log(kLongestM / length_m) / std::log(kLengthStep));
}

float length_m(std::uint8_t steps) {
  return static_cast<float>(kLongestM * std::pow(kLengthStep, -steps));
}

}  // namespace

LandmarkSteps steps_of(const Landmark& landmark, double origin_m) {
  LandmarkSteps steps;
  steps.descriptor = landmark.descriptor;
  steps.east_cm = nearest<std::int16_t>(landmark.position.east_m * kCentimetresAMetre);
  steps.north_cm = nearest<std::int16_t>(landmark.position.north_m * kCentimetresAMetre);
  steps.up_cm = nearest<std::int16_t>(landmark.position.up_m * kCentimetresAMetre);
  steps.depth_sigma = length_steps(landmark.depth_sigma_m);
  steps.size = length_steps(landmark.size_m);
  steps.size_sigma = std::min(nearest<std::uint8_t>(double{landmark.size_sigma} * kSizeSigmaUnits),
                              kSizeSigmaUnits);
  steps.begin_dm = nearest<std::uint16_t>((landmark.along.from_m - origin_m) * kDecimetresAMetre);
  steps.length_dm =
      nearest<std::uint16_t>((landmark.along.to_m - origin_m) * kDecimetresAMetre - steps.begin_dm);
  steps.observations = landmark.observations;
  steps.passes = landmark.passes;
  steps.right_dm =
      std::max(nearest<std::int8_t>(double{landmark.right_m} * kDecimetresAMetre), kLeastRightDm);
  return steps;
}

Landmark landmark_of(const LandmarkSteps& steps, double origin_m) {
  Landmark landmark;
  landmark.descriptor = steps.descriptor;
  landmark.position = {steps.east_cm / kCentimetresAMetre, steps.north_cm / kCentimetresAMetre,
                       steps.up_cm / kCentimetresAMetre};
  landmark.depth_sigma_m = length_m(steps.depth_sigma);
  landmark.size_m = length_m(steps.size);
  landmark.size_sigma = static_cast<float>(steps.size_sigma) / kSizeSigmaUnits;
  landmark.along = {origin_m + steps.begin_dm / kDecimetresAMetre,
                    origin_m + (steps.begin_dm + steps.length_dm) / kDecimetresAMetre};
  landmark.observations = steps.observations;
  landmark.passes = steps.passes;
  landmark.right_m = static_cast<float>(steps.right_dm / kDecimetresAMetre);
  return landmark;
}

}  // namespace milepost
