#include "schema/feature/pca_projection.h"

#include <sodium.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include <nlohmann/json.hpp>

#include "schema/base/ids.h"
#include "schema/feature/root_sift.h"

namespace milepost {
namespace {

constexpr int kMeanUnits = 255;
constexpr int kAxisUnits = 127;
constexpr int kBase64 = sodium_base64_VARIANT_ORIGINAL;

Error corrupt_codebook(const std::string& what) {
  return {ErrorCode::corrupt, "codebook", what, "rebuild the map"};
}

// An array of bytes, or of byte arrays, as base64.
template <class Array>
std::string base64_from(const Array& array) {
  std::string text(sodium_base64_ENCODED_LEN(sizeof array, kBase64), '\0');
  sodium_bin2base64(text.data(), text.size(), reinterpret_cast<const unsigned char*>(array.data()),
                    sizeof array, kBase64);
  text.pop_back();  // the terminating NUL
  return text;
}

// Extracts an array of bytes from `object`.
template <class Array>
Status take(nlohmann::json& object, const char* key, Array& array) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_string()) {
    return corrupt_codebook(std::string("'") + key + "' is missing or not a string");
  }
  const auto& text = found->template get_ref<const std::string&>();
  Array bytes;
  std::size_t length = 0;
  const char* end = nullptr;
  const bool fits =
      sodium_base642bin(reinterpret_cast<unsigned char*>(bytes.data()), sizeof bytes, text.data(),
                        text.size(), nullptr, &length, &end, kBase64) == 0;
  if (!fits || length != sizeof bytes || end != text.data() + text.size()) {
    return corrupt_codebook(std::string("'") + key + "' is not base64 of " +
                            std::to_string(sizeof bytes) + " bytes");
  }
  array = bytes;
  object.erase(found);
  return ok_status();
}

}  // namespace

int distance_squared(const CompactDescriptor& a, const CompactDescriptor& b) {
  int sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const int difference = a[k] - b[k];
    sum += difference * difference;
  }
  return sum;
}

CompactDescriptor PcaProjection::compact(const Descriptor& descriptor) const {
  const RootSift root = root_sift(descriptor);
  std::array<std::int32_t, kCompactValues> sums{};  // below 2^30: 128 * 127 * kRootSiftUnits
  for (std::size_t d = 0; d < root.size(); ++d) {
    const auto centred =
        static_cast<std::int16_t>(root[d] - mean_[d] * (kRootSiftUnits / kMeanUnits));
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += centred * axes_[d][k];
  }
  const double units_a_step = quantization_step_ * kAxisUnits * kRootSiftUnits;
  CompactDescriptor compact;
  std::transform(sums.begin(), sums.end(), compact.begin(), [units_a_step](std::int32_t sum) {
    const double steps = std::nearbyint(sum / units_a_step);
    return static_cast<std::int8_t>(std::clamp<double>(steps, INT8_MIN, INT8_MAX));
  });
  return compact;
}

nlohmann::ordered_json PcaProjection::to_json() const {
  return {{"version", version_},
          {"step", quantization_step_},
          {"mean", base64_from(mean_)},
          {"axes", base64_from(axes_)}};
}

Result<PcaProjection> PcaProjection::from_json(nlohmann::json object) {
  if (!object.is_object()) return corrupt_codebook("it is not a JSON object");
  const auto version = object.find("version");
  const bool is_named = version != object.end() && version->is_string() &&
                        is_segment_id(version->get_ref<const std::string&>());
  if (!is_named) return corrupt_codebook("'version' is missing or not an id");
  const auto step = object.find("step");
  if (step == object.end() || !step->is_number()) {
    return corrupt_codebook("'step' is missing or not a number");
  }
  PcaProjection projection;
  projection.version_ = version->get<std::string>();
  projection.quantization_step_ = step->get<double>();
  if (!(projection.quantization_step_ > 0 && std::isfinite(projection.quantization_step_))) {
    return corrupt_codebook("'step' is not finite and above 0");
  }
  object.erase("version");
  object.erase("step");
  for (const Status& status :
       {take(object, "mean", projection.mean_), take(object, "axes", projection.axes_)}) {
    if (!status.ok()) return status.error();
  }
  for (const auto& components : projection.axes_) {
    if (std::ranges::find(components, INT8_MIN) != components.end()) {
      return corrupt_codebook("a component of 'axes' is below -127");
    }
  }
  if (!object.empty()) return corrupt_codebook("'" + object.begin().key() + "' is unknown");
  return projection;
}

}  // namespace milepost
