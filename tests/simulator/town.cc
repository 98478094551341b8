#include "tests/simulator/town.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "tests/simulator/bridge.h"
#include "tests/simulator/ground.h"
#include "tests/simulator/lots.h"
#include "tests/simulator/planting.h"
#include "tests/simulator/plants.h"
#include "tests/simulator/site.h"
#include "tests/simulator/streetside.h"

namespace milepost::simulator {
namespace {

constexpr double kPatchM = 8;
constexpr double kPlainM = -1.4;     // height of the fields around the town
constexpr int kRoadTexelsPerM = 38;  // near a drive
constexpr int kAwayTexelsPerM = 12;
constexpr double kCloseM = 11;  // from a route's middle, within which the ground needs detail

// Seeds of the parts of a town, so that one part can change without the others.
enum Part : std::uint64_t { kGround = 1, kHouses, kPlants, kParking, kFurniture, kWoods };

std::uint64_t seed_of(std::uint64_t seed, Part part) { return seed * 0x9e3779b97f4a7c15ULL + part; }

int texels_per_m_of(GroundDetail detail) {
  return detail == GroundDetail::road ? kRoadTexelsPerM : kAwayTexelsPerM;
}

bool is_close_to_a_route(const Network& network, const cv::Vec2d& position) {
  return std::any_of(network.routes.begin(), network.routes.end(), [&](const Route& route) {
    return std::abs(route.path.place_of(position).lateral_m) < kCloseM + kPatchM * 0.7;
  });
}

// Squares of a grid that is fixed to the local frame, each split along its diagonal.
void add_ground(Scene& scene, const Site& site, GroundDetail detail, std::uint64_t seed) {
  const Network& network = site.network();
  const auto ground = std::make_shared<Ground>(network, seed);
  const cv::Vec2d from = network.south_west - cv::Vec2d(160, 0);
  const cv::Vec2d to = network.north_east + cv::Vec2d(0, 48);
  for (double west = from[0]; west < to[0]; west += kPatchM) {
    for (double south = from[1]; south < to[1]; south += kPatchM) {
      const cv::Vec2d north_west(west, south + kPatchM);
      const bool is_close = is_close_to_a_route(network, {west + kPatchM / 2, south + kPatchM / 2});
      const int texels_per_m = is_close ? texels_per_m_of(detail) : kAwayTexelsPerM;
      const auto texture = std::make_shared<Texture>(
          [=] { return ground->paint(north_west, kPatchM, texels_per_m); });
      const Point nw = site.on_ground(north_west);
      const Point ne = site.on_ground(north_west + cv::Vec2d(kPatchM, 0));
      const Point se = site.on_ground(north_west + cv::Vec2d(kPatchM, -kPatchM));
      const Point sw = site.on_ground(north_west + cv::Vec2d(0, -kPatchM));
      const auto scale = static_cast<double>(texels_per_m);
      const TextureMap map{nw, {scale, 0, 0}, {0, -scale, 0}};
      scene.surfaces.push_back(polygon({nw, ne, se}, texture, map));
      scene.surfaces.push_back(polygon({nw, se, sw}, texture, map));
    }
  }
}

// A rectangle: its north-western and south-eastern corners.
using Bounds = std::pair<cv::Vec2d, cv::Vec2d>;

// The whole, with a hole for the cutting, which is deeper than the plain.
std::vector<Bounds> plain_of(const Network& network, const Bounds& whole) {
  const auto& cutting = network.terrain.cutting;
  if (!cutting) return {whole};
  const auto& [nw, se] = whole;
  const double half_length_m = cutting->half_level_m + cutting->ramp_m;
  const double half_width_m = cutting->half_floor_m + cutting->slope_m;
  const double west = cutting->centre[0] - half_length_m;
  const double east = cutting->centre[0] + half_length_m;
  const double north = cutting->centre[1] + half_width_m;
  const double south = cutting->centre[1] - half_width_m;
  return {{nw, {se[0], north}},
          {{nw[0], south}, se},
          {{nw[0], north}, {west, south}},
          {{east, north}, {se[0], south}}};
}

// Fields and woods beyond the town.
void add_surroundings(Scene& scene, const Network& network, std::uint64_t seed) {
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
  const cv::Vec2d centre = (network.south_west + network.north_east) * 0.5;
  const cv::Vec2d north_west = centre + cv::Vec2d(-kFarM, kFarM);
  const TextureMap map{{north_west[0], north_west[1], kPlainM},
                       {256 / (2 * kFarM), 0, 0},
                       {0, -256 / (2 * kFarM), 0}};
  for (const Bounds& part : plain_of(network, {north_west, centre + cv::Vec2d(kFarM, -kFarM)})) {
    const auto [nw, se] = part;
    Surface plain = polygon({{nw[0], nw[1], kPlainM},
                             {se[0], nw[1], kPlainM},
                             {se[0], se[1], kPlainM},
                             {nw[0], se[1], kPlainM}},
                            meadow, map);
    plain.is_distant = true;
    scene.surfaces.push_back(plain);
  }
  add_far_woods(scene, centre, 620, seed);
}

// Heights of houses above the ground, by cells of the sky view.
cv::Mat heights_of(const Network& network, const std::vector<Building>& buildings) {
  const cv::Vec2d extent = network.north_east - network.south_west;
  cv::Mat result(static_cast<int>(extent[1] / SkyView::kCellM),
                 static_cast<int>(extent[0] / SkyView::kCellM), CV_32F, cv::Scalar(0));
  for (const Building& building : buildings) {
    std::vector<cv::Point> outline;
    for (const cv::Vec2d& corner : building.footprint) {
      const cv::Vec2d cell = (corner - network.south_west) / SkyView::kCellM;
      outline.emplace_back(static_cast<int>(std::floor(cell[0])),
                           static_cast<int>(std::floor(cell[1])));
    }
    cv::fillConvexPoly(result, outline,
                       cv::Scalar(building.eaves_m + (building.height_m() - building.eaves_m) / 2));
  }
  return result;
}

}  // namespace

Town make_town(std::uint64_t seed, GroundDetail detail) {
  return build_town(make_network(seed), seed, detail);
}

Town build_town(const Network& network, std::uint64_t seed, GroundDetail detail) {
  Town town;
  town.seed = seed;
  town.network = network;
  town.buildings = make_buildings(town.network, seed_of(seed, kHouses));
  const Site site(town.network, town.buildings);
  add_ground(town.scene, site, detail, seed_of(seed, kGround));
  add_bridges(town.scene, town.network, seed_of(seed, kGround), texels_per_m_of(detail));
  for (const Building& building : town.buildings) add_building(town.scene, building);
  plant(town.scene, site, seed_of(seed, kPlants));
  park_vehicles(town.scene, site, seed_of(seed, kParking));
  furnish_streets(town.scene, site, seed_of(seed, kFurniture));
  add_surroundings(town.scene, town.network, seed_of(seed, kWoods));
  town.sky_view =
      std::make_shared<SkyView>(heights_of(town.network, town.buildings), town.network.south_west);
  return town;
}

Lighting light_town(const Town& town, const Light& light) {
  const Terrain terrain = town.network.terrain;
  return {light, std::make_shared<Sky>(light),
          std::make_shared<ShadowMap>(town.scene, light.to_sun()), town.sky_view,
          [terrain](const cv::Vec2d& position) { return terrain.height_m(position); }};
}

}  // namespace milepost::simulator
