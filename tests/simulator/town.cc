#include "tests/simulator/town.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <opencv2/imgproc.hpp>

#include "tests/simulator/facade.h"
#include "tests/simulator/furniture.h"
#include "tests/simulator/ground.h"
#include "tests/simulator/lots.h"
#include "tests/simulator/paint.h"
#include "tests/simulator/plants.h"
#include "tests/simulator/solids.h"
#include "tests/simulator/vehicle.h"

namespace milepost::simulator {
namespace {

constexpr double kPatchM = 8;
constexpr int kRoadTexelsPerM = 38;  // where a drive comes close
constexpr int kAwayTexelsPerM = 12;
constexpr double kCloseM = 11;  // from a route's middle to where the ground needs detail
constexpr double kKerbM = 0.16;

// Seeds of the parts of a town, so that one part can change without the others.
enum Part : std::uint64_t { kGround = 1, kHouses, kPlants, kParking, kFurniture, kWoods };

std::uint64_t seed_of(std::uint64_t seed, Part part) { return seed * 0x9e3779b97f4a7c15ULL + part; }

class Planner {
 public:
  Planner(std::uint64_t seed, GroundDetail detail)
      : detail_(detail), foliage_(seed_of(seed, kPlants)) {
    town_.seed = seed;
    town_.network = make_network(seed);
  }

  Town plan() && {
    town_.buildings = make_buildings(town_.network, seed_of(town_.seed, kHouses));
    add_ground();
    for (const Building& building : town_.buildings) add_building(town_.scene, building);
    plant();
    park_vehicles();
    furnish();
    add_surroundings();
    town_.sky_view = std::make_shared<SkyView>(heights(), town_.network.south_west);
    return std::move(town_);
  }

 private:
  const Network& network() const { return town_.network; }

  Point on_ground(const cv::Vec2d& position) const {
    return {position[0], position[1], network().terrain.height_m(position)};
  }

  bool is_close_to_a_route(const cv::Vec2d& position) const {
    return std::any_of(network().routes.begin(), network().routes.end(), [&](const Route& route) {
      return std::abs(route.path.place_of(position).lateral_m) < kCloseM + kPatchM * 0.7;
    });
  }

  // Squares of a grid that is fixed to the local frame, each bent along its diagonal.
  void add_ground() {
    const auto ground = std::make_shared<Ground>(network(), seed_of(town_.seed, kGround));
    const cv::Vec2d from = network().south_west - cv::Vec2d(160, 0);
    const cv::Vec2d to = network().north_east + cv::Vec2d(0, 48);
    for (double west = from[0]; west < to[0]; west += kPatchM) {
      for (double south = from[1]; south < to[1]; south += kPatchM) {
        const cv::Vec2d north_west(west, south + kPatchM);
        const bool is_close = is_close_to_a_route({west + kPatchM / 2, south + kPatchM / 2});
        const int texels_per_m =
            is_close && detail_ == GroundDetail::road ? kRoadTexelsPerM : kAwayTexelsPerM;
        const auto texture = std::make_shared<Texture>(
            [=] { return ground->paint(north_west, kPatchM, texels_per_m); });
        const Point nw = on_ground(north_west);
        const Point ne = on_ground(north_west + cv::Vec2d(kPatchM, 0));
        const Point se = on_ground(north_west + cv::Vec2d(kPatchM, -kPatchM));
        const Point sw = on_ground(north_west + cv::Vec2d(0, -kPatchM));
        const auto scale = static_cast<double>(texels_per_m);
        const TextureMap map{nw, {scale, 0, 0}, {0, -scale, 0}};
        town_.scene.surfaces.push_back(polygon({nw, ne, se}, texture, map));
        town_.scene.surfaces.push_back(polygon({nw, se, sw}, texture, map));
      }
    }
  }

  bool is_built_on(const cv::Vec2d& position, double margin_m) const {
    return std::any_of(town_.buildings.begin(), town_.buildings.end(),
                       [&](const Building& building) {
                         const auto& outline = building.footprint;
                         for (int i = 0; i < 4; ++i) {
                           const cv::Vec2d edge = cv::normalize(outline[(i + 1) % 4] - outline[i]);
                           const cv::Vec2d offset = position - outline[i];
                           if (offset[0] * edge[1] - offset[1] * edge[0] > margin_m) return false;
                         }
                         return true;
                       });
  }

  // Beside a road, on its pavement or verge; null where a junction or a house is.
  std::optional<Standing> beside(const Road& road, double along_m, int side, double off_m) const {
    const cv::Vec2d at = road.path.position_at({along_m, side * (road.half_width_m + off_m)});
    for (const Road& other : network().roads) {
      if (&other == &road) continue;
      if (std::abs(other.path.place_of(at).lateral_m) < other.half_width_m + 1) return std::nullopt;
    }
    if (is_built_on(at, 0.2)) return std::nullopt;
    const double heading = road.path.heading_rad_at(along_m);
    return Standing{on_ground(at), forward_of(heading), right_of(heading) * -side};
  }

  void plant() {
    cv::RNG random = seeded(seed_of(town_.seed, kPlants));
    const auto add = [&](const cv::Vec2d& at, double least_m, double most_m) {
      Tree tree;
      tree.foot = on_ground(at);
      tree.height_m = random.uniform(least_m, most_m);
      tree.crown_radius_m = tree.height_m * random.uniform(0.24, 0.36);
      tree.kind = random.uniform(0, Foliage::kKinds);
      tree.seed = random.next();
      add_tree(town_.scene, tree, foliage_);
    };
    for (const Road& road : network().roads) {
      for (const int side : {-1, 1}) {
        for (double along = random.uniform(4.0, 9.0); along < road.path.length_m();
             along += random.uniform(8.0, 15.0)) {
          const Frontage frontage = road.frontage_at(along);
          const bool is_avenue = frontage == Frontage::avenue && road.name != "roundabout";
          const bool is_row = frontage == Frontage::open && random.uniform(0, 3) == 0;
          const bool is_canyon = frontage == Frontage::canyon && random.uniform(0, 6) == 0;
          if (!is_avenue && !is_row && !is_canyon) continue;
          const double off_m = is_row ? random.uniform(2.5, 7.0) : 0.9;
          if (const auto at = beside(road, along, side, off_m)) {
            add({at->foot[0], at->foot[1]}, is_canyon ? 5 : 6, is_canyon ? 7 : 10);
          }
        }
      }
    }
    for (int i = 0; i < 900; ++i) {  // in yards and fields
      const cv::Vec2d at(random.uniform(network().south_west[0] - 100, network().north_east[0]),
                         random.uniform(network().south_west[1], network().north_east[1]));
      const double clear = clearance_m(network(), at);
      if (clear < 4 || is_built_on(at, 2.5)) continue;
      if (clear > 30 && random.uniform(0, 3) > 0) continue;
      add(at, 5, 12);
    }
    const Road& ring = network().roads.back();
    const cv::Vec2d centre =
        (ring.path.position_at({0, 0}) + ring.path.position_at({ring.path.length_m() / 2, 0})) *
        0.5;
    for (int i = 0; i < 5; ++i) {
      add(centre + cv::Vec2d(random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0)), 4, 7);
    }
    add_garden_edges(random);
  }

  // Hedges and walls between the pavement and what is not built on.
  void add_garden_edges(cv::RNG& random) {
    constexpr double kPieceM = 3;
    for (const Road& road : network().roads) {
      if (road.name == "roundabout") continue;
      for (const int side : {-1, 1}) {
        bool is_hedge = true;
        for (double along = 0; along + kPieceM < road.path.length_m(); along += kPieceM) {
          if (random.uniform(0, 4) == 0) is_hedge = random.uniform(0, 2) == 0;
          const Frontage frontage = road.frontage_at(along);
          if (frontage == Frontage::open || random.uniform(0, 6) == 0) continue;
          const double off_m = kKerbM + pavement_width_m(frontage) + 0.35;
          const auto near = beside(road, along, side, off_m);
          const auto far = beside(road, along + kPieceM, side, off_m);
          const auto behind = beside(road, along + kPieceM / 2, side, off_m + 2);
          if (!near || !far || !behind) continue;
          add_edge(near->foot, far->foot, is_hedge, random);
        }
      }
    }
  }

  void add_edge(const Point& near, const Point& far, bool is_hedge, cv::RNG& random) {
    const Point middle = (near + far) * 0.5 - kUp * 0.2;
    const double length_m = cv::norm(far - near);
    const cv::Vec2d forward = cv::normalize(cv::Vec2d(far[0] - near[0], far[1] - near[1]));
    if (is_hedge) {
      add_box(town_.scene, {middle, forward, length_m, 0.6, random.uniform(1.1, 1.6)},
              foliage_.hedge(), Foliage::kHedgeTexelsPerM);
      return;
    }
    const WallSize size{length_m, random.uniform(1.1, 1.9)};
    const auto texture =
        painted([=](cv::RNG& own) { return paint_garden_wall(size, own); }, random.next());
    add_box(town_.scene, {middle, forward, length_m, 0.25, size.height_m}, texture,
            size.texels_per_m);
  }

  void park_vehicles() {
    cv::RNG random = seeded(seed_of(town_.seed, kParking));
    for (std::size_t i = 0; i < network().roads.size(); ++i) {
      const Road& road = network().roads[i];
      if (road.parking_m == 0) continue;
      for (const int side : {-1, 1}) {
        for (double along = 4; along + 4 < road.path.length_m(); along += 6) {
          const int kind = random.uniform(0, 12);
          const std::uint64_t look = random.next();
          const double shift_m = random.uniform(-0.35, 0.35);
          if (kind >= 8 || is_near_mouth(i, along)) continue;
          const cv::Vec2d at = road.path.position_at(
              {along + shift_m, side * (road.half_width_m - road.parking_m / 2 - 0.02)});
          const double heading = road.path.heading_rad_at(along) + random.uniform(-0.03, 0.03);
          const Vehicle vehicle(kind < 4   ? VehicleKind::hatchback
                                : kind < 7 ? VehicleKind::saloon
                                           : VehicleKind::van,
                                look);
          vehicle.add_to(town_.scene.surfaces, on_ground(at), forward_of(heading) * side);
        }
      }
    }
  }

  // Whether another road opens near a place of a road, or a crossing is there.
  bool is_near_mouth(std::size_t road, double along_m) const {
    const cv::Vec2d at = network().roads[road].path.position_at({along_m, 0});
    for (std::size_t i = 0; i < network().roads.size(); ++i) {
      const Road& other = network().roads[i];
      if (i == road) continue;
      if (std::abs(other.path.place_of(at).lateral_m) < other.half_width_m + 10) return true;
    }
    return false;
  }

  void furnish() {
    cv::RNG random = seeded(seed_of(town_.seed, kFurniture));
    for (const Road& road : network().roads) {
      int side = 1;
      for (double along = 8; along < road.path.length_m(); along += random.uniform(11.0, 15.0)) {
        side = -side;
        if (road.frontage_at(along) == Frontage::open) continue;
        if (const auto at = beside(road, along, side, 0.5)) add_lamp(town_.scene, *at, random);
      }
      for (const int each : {-1, 1}) {
        for (double along = 3; along < road.path.length_m(); along += random.uniform(4.0, 13.0)) {
          add_something(road, along, each, random);
        }
      }
    }
  }

  void add_something(const Road& road, double along_m, int side, cv::RNG& random) {
    const int kind = random.uniform(0, 10);
    const bool is_open = road.frontage_at(along_m) == Frontage::open;
    if (is_open) {
      const auto at = beside(road, along_m, side, 1.1);
      if (at && kind < 5) add_bollard(town_.scene, *at, random);
      if (at && kind == 5) add_traffic_sign(town_.scene, *at, random);
      return;
    }
    const double wide_m = pavement_width_m(road.frontage_at(along_m));
    const auto kerb = beside(road, along_m, side, 0.45);
    const auto wall = beside(road, along_m, side, wide_m - 0.45);
    if (!kerb || !wall) return;
    if (kind < 3) {
      add_traffic_sign(town_.scene, *kerb, random);
    } else if (kind < 5) {
      add_bollard(town_.scene, *kerb, random);
    } else if (kind < 7) {
      add_bin(town_.scene, *wall, random);
    } else if (kind == 7) {
      add_cabinet(town_.scene, *wall, random);
    } else if (kind == 8 && wide_m > 2.5) {
      add_column(town_.scene, *kerb, random);
    }
  }

  void add_surroundings() {
    const auto meadow = std::make_shared<Texture>([] {
      cv::Mat image(256, 256, CV_8UC3, cv::Scalar(52, 106, 84));
      cv::RNG random(9);
      for (int field = 0; field < 60; ++field) {
        const cv::Scalar colour(random.uniform(40, 80), random.uniform(95, 140),
                                random.uniform(75, 140));
        const cv::Point at(random.uniform(0, 256), random.uniform(0, 256));
        cv::rectangle(image, at, at + cv::Point(random.uniform(10, 60), random.uniform(8, 40)),
                      colour, -1);
      }
      cv::GaussianBlur(image, image, {}, 1.0);
      return image;
    });
    constexpr double kFarM = 1200;
    const cv::Vec2d centre = (network().south_west + network().north_east) * 0.5;
    Surface plain = rectangle({centre[0] - kFarM, centre[1] + kFarM, -1.4}, {1, 0, 0}, {0, -1, 0},
                              2 * kFarM, 2 * kFarM, meadow, {256, 256});
    plain.is_distant = true;
    town_.scene.surfaces.push_back(plain);
    add_far_woods(town_.scene, centre, 620, seed_of(town_.seed, kWoods));
  }

  // Heights of houses above the ground, by cells of the sky view.
  cv::Mat heights() const {
    const cv::Vec2d extent = network().north_east - network().south_west;
    cv::Mat result(static_cast<int>(extent[1] / SkyView::kCellM),
                   static_cast<int>(extent[0] / SkyView::kCellM), CV_32F, cv::Scalar(0));
    for (const Building& building : town_.buildings) {
      std::vector<cv::Point> outline;
      for (const cv::Vec2d& corner : building.footprint) {
        const cv::Vec2d cell = (corner - network().south_west) / SkyView::kCellM;
        outline.emplace_back(static_cast<int>(std::floor(cell[0])),
                             static_cast<int>(std::floor(cell[1])));
      }
      cv::fillConvexPoly(
          result, outline,
          cv::Scalar(building.eaves_m + (building.height_m() - building.eaves_m) / 2));
    }
    return result;
  }

  GroundDetail detail_;
  Town town_;
  Foliage foliage_;
};

}  // namespace

Town make_town(std::uint64_t seed, GroundDetail detail) { return Planner(seed, detail).plan(); }

Lighting light_town(const Town& town, const Light& light) {
  const Terrain terrain = town.network.terrain;
  return {light, std::make_shared<Sky>(light),
          std::make_shared<ShadowMap>(town.scene, light.to_sun()), town.sky_view,
          [terrain](const cv::Vec2d& position) { return terrain.height_m(position); }};
}

}  // namespace milepost::simulator
