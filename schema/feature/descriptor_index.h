// Nearest neighbours among descriptors by FLANN's randomized k-d trees (the tracklet paper's [26]).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "schema/feature/types.h"

namespace milepost {

struct Neighbour {
  std::size_t index = 0;       // into the descriptors of the index
  float distance_squared = 0;  // Euclidean
};

struct IndexSettings {
  int trees = 2;    // randomized trees; more find better neighbours at a higher cost of building
  int checks = 32;  // leaves visited per query
};

// Refers to the descriptors that it was built from, which must outlive it.
// Immutable after construction; nearest() may be called from several threads. The trees are seeded,
// so the same descriptors always give the same neighbours.
class DescriptorIndex {
 public:
  DescriptorIndex(std::span<const Descriptor> descriptors, const IndexSettings& settings);
  ~DescriptorIndex();
  DescriptorIndex(DescriptorIndex&&) noexcept;
  DescriptorIndex& operator=(DescriptorIndex&&) noexcept;

  // Up to `count` neighbours of each query, nearest first: fewer only if the index holds fewer.
  std::vector<std::vector<Neighbour>> nearest(std::span<const Descriptor> queries,
                                              std::size_t count) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

float distance_squared(const Descriptor& a, const Descriptor& b);

}  // namespace milepost
