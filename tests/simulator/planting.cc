#include "tests/simulator/planting.h"

#include <cmath>

#include "tests/simulator/facade.h"
#include "tests/simulator/lots.h"
#include "tests/simulator/paint.h"
#include "tests/simulator/plants.h"
#include "tests/simulator/solids.h"

namespace milepost::simulator {
namespace {

class Gardener {
 public:
  Gardener(Scene& scene, const Site& site, std::uint64_t seed)
      : scene_(scene), site_(site), random_(seeded(seed)), foliage_(seed) {}

  void plant() {
    plant_streets();
    plant_yards();
    for (const Road& road : site_.network().roads) {
      if (road.name == "roundabout") plant_roundabout(road);
    }
    add_garden_edges();
  }

 private:
  void add_tree_at(const cv::Vec2d& at, double least_m, double most_m) {
    Tree tree;
    tree.foot = site_.on_ground(at);
    tree.height_m = random_.uniform(least_m, most_m);
    tree.crown_radius_m = tree.height_m * random_.uniform(0.24, 0.36);
    tree.kind = random_.uniform(0, Foliage::kKinds);
    tree.seed = random_.next();
    add_tree(scene_, tree, foliage_);
  }

  void plant_streets() {
    for (const Road& road : site_.network().roads) {
      for (const int side : {-1, 1}) {
        for (double along = random_.uniform(4.0, 9.0); along < road.path.length_m();
             along += random_.uniform(8.0, 15.0)) {
          const Frontage frontage = road.frontage_at(along);
          const bool is_avenue = frontage == Frontage::avenue && road.name != "roundabout";
          const bool is_row = frontage == Frontage::open && random_.uniform(0, 3) == 0;
          const bool is_canyon = frontage == Frontage::canyon && random_.uniform(0, 6) == 0;
          if (!is_avenue && !is_row && !is_canyon) continue;
          const double off_m = is_row ? random_.uniform(2.5, 7.0) : 0.9;
          if (const auto at = site_.beside(road, along, side, off_m)) {
            add_tree_at({at->foot[0], at->foot[1]}, is_canyon ? 5 : 6, is_canyon ? 7 : 10);
          }
        }
      }
    }
  }

  void plant_yards() {
    constexpr double kTriesPerHectare = 26.22;
    const long tries = std::lround(kTriesPerHectare * hectares(site_.network()));
    for (long i = 0; i < tries; ++i) {  // in yards and fields
      const cv::Vec2d at(
          random_.uniform(site_.network().south_west[0] - 100, site_.network().north_east[0]),
          random_.uniform(site_.network().south_west[1], site_.network().north_east[1]));
      const double clear = clearance_m(site_.network(), at);
      if (clear < 4 || site_.is_built_on(at, 2.5)) continue;
      if (clear > 30 && random_.uniform(0, 3) > 0) continue;
      add_tree_at(at, 5, 12);
    }
  }

  void plant_roundabout(const Road& ring) {
    const cv::Vec2d east = ring.path.position_at({0, 0});
    const cv::Vec2d west = ring.path.position_at({ring.path.length_m() / 2, 0});
    const cv::Vec2d centre = (east + west) * 0.5;
    const double island_m = cv::norm(east - west) / 2 - ring.half_width_m;
    const double off_m = island_m > 8 ? 5 : island_m / 4;
    for (int i = 0; i < 5; ++i) {
      add_tree_at(
          centre + cv::Vec2d(random_.uniform(-off_m, off_m), random_.uniform(-off_m, off_m)), 4, 7);
    }
  }

  // Hedges and walls between the pavement and undeveloped ground.
  void add_garden_edges() {
    constexpr double kPieceM = 3;
    for (const Road& road : site_.network().roads) {
      if (road.name == "roundabout") continue;
      for (const int side : {-1, 1}) {
        bool is_hedge = true;
        for (double along = 0; along + kPieceM < road.path.length_m(); along += kPieceM) {
          if (random_.uniform(0, 4) == 0) is_hedge = random_.uniform(0, 2) == 0;
          const Frontage frontage = road.frontage_at(along);
          if (frontage == Frontage::open || random_.uniform(0, 6) == 0) continue;
          const double off_m = kKerbM + pavement_width_m(frontage) + 0.35;
          const auto near = site_.beside(road, along, side, off_m);
          const auto far = site_.beside(road, along + kPieceM, side, off_m);
          const auto behind = site_.beside(road, along + kPieceM / 2, side, off_m + 2);
          if (!near || !far || !behind) continue;
          add_edge(near->foot, far->foot, is_hedge);
        }
      }
    }
  }

  void add_edge(const Point& near, const Point& far, bool is_hedge) {
    const Point middle = (near + far) * 0.5 - kUp * 0.2;
    const double length_m = cv::norm(far - near);
    const cv::Vec2d forward = cv::normalize(cv::Vec2d(far[0] - near[0], far[1] - near[1]));
    if (is_hedge) {
      add_box(scene_, {middle, forward, length_m, 0.6, random_.uniform(1.1, 1.6)}, foliage_.hedge(),
              Foliage::kHedgeTexelsPerM);
      return;
    }
    const WallSize size{length_m, random_.uniform(1.1, 1.9)};
    const auto texture =
        painted([=](cv::RNG& own) { return paint_garden_wall(size, own); }, random_.next());
    add_box(scene_, {middle, forward, length_m, 0.25, size.height_m}, texture, size.texels_per_m);
  }

  Scene& scene_;
  const Site& site_;
  cv::RNG random_;
  Foliage foliage_;
};

}  // namespace

void plant(Scene& scene, const Site& site, std::uint64_t seed) {
  Gardener(scene, site, seed).plant();
}

}  // namespace milepost::simulator
