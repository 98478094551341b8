// Trees, hedges and woods.
#pragma once

#include <memory>
#include <vector>

#include "tests/simulator/scene.h"

namespace milepost::simulator {

// Textures of foliage, shared by all plants.
class Foliage {
 public:
  explicit Foliage(std::uint64_t seed);

  static constexpr double kClumpM = 1.9;  // side of a clump's square
  const std::shared_ptr<const Texture>& clump(int kind, cv::RNG& random) const;
  const std::shared_ptr<const Texture>& hedge() const { return hedge_; }
  const std::shared_ptr<const Texture>& bark() const { return bark_; }

  static constexpr int kKinds = 3;
  static constexpr int kTexels = 128;  // of a clump's side
  static constexpr double kHedgeTexelsPerM = 48;

 private:
  std::vector<std::shared_ptr<const Texture>> clumps_;
  std::shared_ptr<const Texture> hedge_, bark_;
};

struct Tree {
  Point foot;
  double height_m = 8;
  double crown_radius_m = 2.4;
  int kind = 0;
  std::uint64_t seed = 1;
};

void add_tree(Scene& scene, const Tree& tree, const Foliage& foliage);

// Distant woods all around, which close the view where no house does.
void add_far_woods(Scene& scene, const cv::Vec2d& centre, double distance_m, std::uint64_t seed);

}  // namespace milepost::simulator
