#include "schema/feature/descriptor_index.h"

#include <algorithm>

#include <opencv2/core.hpp>
#include <opencv2/flann.hpp>

namespace milepost {
namespace {

using Distance = cvflann::L2<unsigned char>;
using Trees = cvflann::KDTreeIndex<Distance>;

constexpr unsigned kSeed = 2017;

// FLANN takes mutable matrices but does not write to them.
cvflann::Matrix<unsigned char> as_matrix(std::span<const Descriptor> descriptors) {
  auto* data = const_cast<unsigned char*>(descriptors.front().data());  // NOLINT
  return {data, descriptors.size(), static_cast<std::size_t>(kDescriptorBytes)};
}

}  // namespace

struct DescriptorIndex::Impl {
  std::size_t size = 0;
  int checks = 0;
  std::unique_ptr<Trees> trees;  // empty for an empty index
};

DescriptorIndex::DescriptorIndex(std::span<const Descriptor> descriptors,
                                 const IndexSettings& settings)
    : impl_(std::make_unique<Impl>()) {
  impl_->size = descriptors.size();
  impl_->checks = settings.checks;
  if (descriptors.empty()) return;
  cvflann::seed_random(kSeed);  // of this thread's generator
  impl_->trees = std::make_unique<Trees>(as_matrix(descriptors),
                                         cvflann::KDTreeIndexParams(settings.trees), Distance());
  impl_->trees->buildIndex();
}

DescriptorIndex::~DescriptorIndex() = default;
DescriptorIndex::DescriptorIndex(DescriptorIndex&&) noexcept = default;
DescriptorIndex& DescriptorIndex::operator=(DescriptorIndex&&) noexcept = default;

std::vector<std::vector<Neighbour>> DescriptorIndex::nearest(std::span<const Descriptor> queries,
                                                             std::size_t count) const {
  std::vector<std::vector<Neighbour>> result(queries.size());
  const std::size_t found = std::min(count, impl_->size);
  if (found == 0) return result;
  std::vector<int> indices(found);
  std::vector<float> distances(found);
  cvflann::Matrix<int> index_row(indices.data(), 1, found);
  cvflann::Matrix<float> distance_row(distances.data(), 1, found);
  const cvflann::SearchParams search(impl_->checks);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    impl_->trees->knnSearch(as_matrix(queries.subspan(i, 1)), index_row, distance_row,
                            static_cast<int>(found), search);
    for (std::size_t k = 0; k < found; ++k) {
      if (indices[k] < 0) break;
      result[i].push_back({static_cast<std::size_t>(indices[k]), distances[k]});
    }
  }
  return result;
}

float distance_squared(const Descriptor& a, const Descriptor& b) {
  int sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const int difference = a[i] - b[i];
    sum += difference * difference;
  }
  return static_cast<float>(sum);
}

}  // namespace milepost
