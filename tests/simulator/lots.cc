#include "tests/simulator/lots.h"

#include <algorithm>
#include <cmath>

#include "tests/simulator/paint.h"

namespace milepost::simulator {
namespace {

using Outline = std::array<cv::Vec2d, 4>;

// Whether one side of `a` separates the two outlines.
bool is_parted_by(const Outline& a, const Outline& b) {
  for (int i = 0; i < 4; ++i) {
    const cv::Vec2d edge = a[(i + 1) % 4] - a[i];
    const cv::Vec2d out(edge[1], -edge[0]);
    const bool is_outside = std::all_of(b.begin(), b.end(), [&](const cv::Vec2d& corner) {
      return (corner - a[i]).dot(out) >= -0.05 * cv::norm(out);
    });
    if (is_outside) return true;
  }
  return false;
}

struct Lot {
  double width_m, depth_m, setback_m, gap_m;
};

Lot any_lot(Frontage frontage, cv::RNG& random) {
  switch (frontage) {
    case Frontage::canyon:
      return {random.uniform(9.0, 17.0), random.uniform(10.0, 13.0), random.uniform(0.0, 0.4),
              random.uniform(0, 9) == 0 ? random.uniform(2.0, 3.5) : 0.0};
    case Frontage::avenue:
      return {random.uniform(8.0, 14.0), random.uniform(8.0, 11.0), random.uniform(2.5, 5.0),
              random.uniform(2.5, 7.0)};
    case Frontage::narrow:
      return {random.uniform(6.5, 12.0), random.uniform(8.0, 11.0), random.uniform(0.0, 0.7),
              random.uniform(0, 5) == 0 ? random.uniform(1.5, 4.0) : 0.0};
    case Frontage::open:
      break;
  }
  return {random.uniform(10.0, 20.0), random.uniform(8.0, 12.0), random.uniform(7.0, 16.0),
          random.uniform(28.0, 70.0)};
}

Building any_building(Frontage frontage, cv::RNG& random) {
  Building building;
  building.frontage = frontage;
  building.seed = random.next();
  building.ridge_m = random.uniform(2.6, 4.4);
  const int kind = random.uniform(0, 10);
  switch (frontage) {
    case Frontage::canyon:
      building.eaves_m = 3.8 + 3.1 * random.uniform(3, 5) + random.uniform(0.0, 1.0);
      building.roof = kind < 5 ? Roof::gable : kind < 6 ? Roof::gable_to_street : Roof::flat;
      break;
    case Frontage::avenue:
      building.eaves_m = 3.4 + 2.9 * random.uniform(1, 3) + random.uniform(0.0, 0.6);
      building.roof = kind < 4   ? Roof::gable
                      : kind < 7 ? Roof::hip
                      : kind < 9 ? Roof::gable_to_street
                                 : Roof::flat;
      break;
    case Frontage::narrow:
      building.eaves_m = 3.5 + 2.9 * random.uniform(1, 4) + random.uniform(0.0, 0.8);
      building.roof = kind < 7 ? Roof::gable : kind < 9 ? Roof::gable_to_street : Roof::flat;
      break;
    case Frontage::open:
      building.eaves_m = 3.2 + 2.8 * random.uniform(0, 2) + random.uniform(0.0, 0.8);
      building.roof = kind < 7 ? Roof::gable : Roof::hip;
      break;
  }
  return building;
}

class Developer {
 public:
  Developer(const Network& network, std::uint64_t seed)
      : network_(network), random_(seeded(seed)) {}

  std::vector<Building> develop() {
    for (const Road& road : network_.roads) {
      if (road.name == "roundabout") continue;
      for (const int side : {-1, 1}) develop_side(road, side);
    }
    for (const Road& road : network_.roads) close_end(road);
    fill_yards();
    return std::move(buildings_);
  }

 private:
  void develop_side(const Road& road, int side) {
    double along = 0;
    while (along < road.path.length_m()) {
      const Frontage frontage = road.frontage_at(along);
      Lot lot = any_lot(frontage, random_);
      const double least_m = frontage == Frontage::open ? 9 : 5.5;
      bool is_built = false;
      while (!is_built && lot.width_m >= least_m) {
        is_built = build_at(road, side, along, lot);
        if (!is_built) lot.width_m -= 1.5;
      }
      along += is_built ? lot.width_m + lot.gap_m : 1.2;
    }
  }

  bool build_at(const Road& road, int side, double along_m, const Lot& lot) {
    const Frontage frontage = road.frontage_at(along_m);
    const double lateral =
        side * (road.half_width_m + kKerbM + pavement_width_m(frontage) + lot.setback_m);
    const cv::Vec2d near = road.path.position_at({along_m, lateral});
    const cv::Vec2d far = road.path.position_at({along_m + lot.width_m, lateral});
    // On the right side of the road, the far end is on the left, seen from the road.
    return build(side > 0 ? far : near, side > 0 ? near : far, lot.depth_m, frontage);
  }

  bool build(const cv::Vec2d& left, const cv::Vec2d& right, double depth_m, Frontage frontage) {
    const cv::Vec2d across = (right - left) * (1 / cv::norm(right - left));
    const cv::Vec2d back = cv::Vec2d(-across[1], across[0]) * depth_m;
    const Outline outline = {left, right, right + back, left + back};
    if (!is_free(outline)) return false;
    Building building = any_building(frontage, random_);
    building.footprint = outline;
    building.ground_m = network_.terrain.height_m((left + right) * 0.5);
    double lowest = building.ground_m;
    for (const cv::Vec2d& corner : outline) {
      lowest = std::min(lowest, network_.terrain.height_m(corner));
    }
    building.foundation_m = building.ground_m - lowest + 0.3;
    if (building.roof == Roof::gable_to_street) {
      building.ridge_m = std::min(building.ridge_m, cv::norm(right - left) * 0.45);
    }
    buildings_.push_back(building);
    return true;
  }

  bool is_free(const Outline& outline) const {
    constexpr double kStep = 0.125;
    for (int i = 0; i < 4; ++i) {
      for (double part = 0; part < 1; part += kStep) {
        const cv::Vec2d at = outline[i] * (1 - part) + outline[(i + 1) % 4] * part;
        if (clearance_m(network_, at) < -0.06 || is_in_cutting(at)) return false;
        if (at[0] < network_.south_west[0] || at[1] < network_.south_west[1] ||
            at[0] > network_.north_east[0] || at[1] > network_.north_east[1]) {
          return false;
        }
      }
    }
    return std::none_of(buildings_.begin(), buildings_.end(),
                        [&](const Building& other) { return overlaps(outline, other.footprint); });
  }

  bool is_in_cutting(const cv::Vec2d& at) const {
    constexpr double kShallowM = 0.5;
    const auto& cutting = network_.terrain.cutting;
    return cutting && cutting->depth_m_at(at) > kShallowM;
  }

  // A house across a road's blind end closes the view.
  void close_end(const Road& road) {
    const double end = road.path.length_m();
    for (const auto& [along, outwards] : {std::pair{0.0, -1.0}, std::pair{end, 1.0}}) {
      const double ahead = along + outwards * (road.half_width_m + 4);
      const cv::Vec2d left = road.path.position_at({ahead, -9 * outwards});
      const cv::Vec2d right = road.path.position_at({ahead, 9 * outwards});
      build(left, right, 10, Frontage::avenue);
    }
  }

  // Sheds and houses at the back.
  void fill_yards() {
    constexpr double kTriesPerHectare = 20.4;
    const long tries = std::lround(kTriesPerHectare * hectares(network_));
    for (long i = 0; i < tries; ++i) {
      const cv::Vec2d at(random_.uniform(network_.yards_east_m, network_.north_east[0] - 20),
                         random_.uniform(network_.south_west[1] + 20, network_.north_east[1] - 20));
      const double heading = random_.uniform(0, 4) * CV_PI / 2 + random_.uniform(-0.15, 0.15);
      const double clear = clearance_m(network_, at);
      if (clear < 8 || clear > 60) continue;
      const cv::Vec2d half = forward_of(heading) * random_.uniform(2.0, 5.0);
      build(at - half, at + half, random_.uniform(4.0, 8.0), Frontage::open);
    }
  }

  const Network& network_;
  cv::RNG random_;
  std::vector<Building> buildings_;
};

}  // namespace

double clearance_m(const Network& network, const cv::Vec2d& position) {
  double least = 1e9;
  for (const Road& road : network.roads) {
    const RoadPlace place = road.path.place_of(position);
    const double belongs =
        road.half_width_m + kKerbM + pavement_width_m(road.frontage_at(place.along_m));
    least = std::min(least, std::abs(place.lateral_m) - belongs);
  }
  return least;
}

bool overlaps(const Outline& a, const Outline& b) {
  return !is_parted_by(a, b) && !is_parted_by(b, a);
}

std::vector<Building> make_buildings(const Network& network, std::uint64_t seed) {
  return Developer(network, seed).develop();
}

}  // namespace milepost::simulator
