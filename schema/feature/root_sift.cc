#include "schema/feature/root_sift.h"

#include <cmath>
#include <numeric>

namespace milepost {

RootSift root_sift(const Descriptor& descriptor) {
  RootSift root{};
  const int sum = std::accumulate(descriptor.begin(), descriptor.end(), 0);
  if (sum == 0) return root;
  for (std::size_t d = 0; d < root.size(); ++d) {
    const float value = std::sqrt(static_cast<float>(descriptor[d]) / static_cast<float>(sum));
    root[d] = static_cast<std::int16_t>(std::nearbyint(value * kRootSiftUnits));
  }
  return root;
}

}  // namespace milepost
