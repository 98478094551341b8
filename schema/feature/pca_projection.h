// Compact descriptors: RootSIFT (Arandjelovic and Zisserman 2012) projected on the first principal
// axes of SIFT descriptors (Ke and Sukthankar 2004, on patches), one byte per coordinate.
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

// Coordinates along a codebook's axes in quantization steps, the axis of the greatest variance
// first.
using CompactDescriptor = std::array<std::int8_t, kCompactValues>;

// Squared Euclidean distance in quantization steps.
int distance_squared(const CompactDescriptor& a, const CompactDescriptor& b);

// A map's codebook (a PCA projection with a quantization step), stored once per map with its layer.
// Immutable after construction, so safe to share between threads.
class PcaProjection {
 public:
  // The principal axes of the descriptors' RootSIFT, which has length 1. All axes
  // have the same quantization step, so that axes of little variance cost few bits once the
  // tile is compressed. The same descriptors in the same order give the same codebook.
  // REQUIRES: quantization_step > 0. Axes without variance (too few descriptors) are zero. Defined
  // in milepost::feature (Eigen); the rest is in milepost::feature_types.
  static PcaProjection trained(std::span<const Descriptor> descriptors, double quantization_step,
                               std::string version = "trained");

  // A JSON object; from_json(to_json()) gives a bit-identical codebook.
  // Errors: corrupt (a missing key, a wrong length, a value out of range).
  nlohmann::ordered_json to_json() const;
  static Result<PcaProjection> from_json(nlohmann::json object);

  // Saturates coordinates to 8 bits. Integer arithmetic: the same result on every machine.
  CompactDescriptor compact(const Descriptor& descriptor) const;
  double quantization_step() const { return quantization_step_; }
  // Which codebook it is, an id: "trained" for one of the map's own descriptors.
  const std::string& version() const { return version_; }

  friend bool operator==(const PcaProjection&, const PcaProjection&) = default;

 private:
  PcaProjection() = default;

  std::string version_ = "trained";
  double quantization_step_ = 0;
  std::array<std::uint8_t, kDescriptorBytes> mean_{};  // of RootSIFT, in 1/255
  // In 1/127: for each value of a descriptor its component of every axis.
  std::array<std::array<std::int8_t, kCompactValues>, kDescriptorBytes> axes_{};
};

}  // namespace milepost
