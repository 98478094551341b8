// Descriptors cut to what tells them apart: RootSIFT (Arandjelovic and Zisserman 2012) along the
// first principal axes of a map's own descriptors (Ke and Sukthankar 2004, on patches), one byte
// each.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "schema/base/result.h"
#include "schema/feature/descriptor.h"

namespace milepost {

inline constexpr int kCompactValues = 32;

// Coordinates along a codebook's axes, in steps, the axis of the greatest variance first.
using CompactDescriptor = std::array<std::int8_t, kCompactValues>;

// Squared Euclidean distance in steps of the codebook.
int distance_squared(const CompactDescriptor& a, const CompactDescriptor& b);

// What a map's compact descriptors are coordinates of; stored once a map, with its layer. Immutable
// after construction, so safe to share between threads.
class Codebook {
 public:
  // The principal axes of the descriptors' RootSIFT, which has length 1. `step` is the length of
  // one unit of every axis: one for all, so that axes of little variance cost few bits once the
  // tile is compressed. The same descriptors in the same order give the same codebook.
  // REQUIRES: step > 0. Axes without variance (too few descriptors) are zero. Defined in
  // milepost::feature (Eigen); the rest is in milepost::feature_types.
  static Codebook trained(std::span<const Descriptor> descriptors, double step);

  // A JSON object; from_json(to_json()) gives the same codebook to the bit.
  // Errors: corrupt (a missing key, a wrong length, a value out of range).
  nlohmann::ordered_json to_json() const;
  static Result<Codebook> from_json(nlohmann::json object);

  // Saturates where a coordinate is beyond 8 bits. Sums whole numbers: the same on every machine.
  CompactDescriptor compact(const Descriptor& descriptor) const;
  double step() const { return step_; }

  friend bool operator==(const Codebook&, const Codebook&) = default;

 private:
  Codebook() = default;

  double step_ = 0;
  std::array<std::uint8_t, kDescriptorBytes> mean_{};  // of RootSIFT, in 1/255
  // In 1/127: for each value of a descriptor its component of every axis.
  std::array<std::array<std::int8_t, kCompactValues>, kDescriptorBytes> axes_{};
};

}  // namespace milepost
