#include "tests/simulator/network.h"

#include <algorithm>
#include <cmath>

#include "tests/simulator/paint.h"

namespace milepost::simulator {
namespace {

constexpr double kRingRadiusM = 12;
constexpr double kRingHalfWidthM = 3.6;
constexpr double kSideHalfWidthM = 3.25;

Road side_road(const std::string& name, Path path, std::vector<Stretch> stretches) {
  Road road;
  road.name = name;
  road.path = std::move(path);
  road.half_width_m = kSideHalfWidthM;
  road.stretches = std::move(stretches);
  return road;
}

// Into a roundabout from the west and out to the north, three quarters of the way around.
std::vector<Bend> around(const cv::Vec2d& centre) {
  constexpr double kInnerM = kRingRadiusM - kLaneM;
  const double corner_m = kInnerM / std::cos(CV_PI / 8);
  std::vector<Bend> bends = {{centre + cv::Vec2d(-17, 0), 15}};
  for (const double angle_deg : {202.5, 247.5, 292.5, 337.5, 382.5, 427.5}) {
    const double angle = angle_deg * CV_PI / 180;
    bends.push_back(
        {centre + cv::Vec2d(std::cos(angle), std::sin(angle)) * corner_m, kInnerM * 0.999});
  }
  bends.push_back({centre + cv::Vec2d(0, 17), 15});
  return bends;
}

}  // namespace

Frontage Road::frontage_at(double along_m) const {
  Frontage frontage = stretches.front().frontage;
  for (const Stretch& stretch : stretches) {
    if (along_m >= stretch.from_m) frontage = stretch.frontage;
  }
  return frontage;
}

double pavement_width_m(Frontage frontage) {
  switch (frontage) {
    case Frontage::canyon:
      return 2.8;
    case Frontage::avenue:
      return 2.2;
    case Frontage::narrow:
      return 1.6;
    case Frontage::open:
      break;
  }
  return 0;
}

const RouteSpan& Route::span_at(double along_m) const {
  static const RouteSpan plain;
  const auto after =
      std::upper_bound(spans.begin(), spans.end(), along_m,
                       [](double along, const RouteSpan& span) { return along < span.from_m; });
  if (spans.empty()) return plain;
  return after == spans.begin() ? spans.front() : *std::prev(after);
}

double Route::height_m(const Terrain& terrain, double along_m, const cv::Vec2d& position) const {
  return span_at(along_m).is_on_bridge ? terrain.uncut_height_m(position)
                                       : terrain.height_m(position);
}

bool Bridge::is_over(const cv::Vec2d& position) const {
  return position[0] > south_west[0] && position[0] < north_east[0] &&
         position[1] > south_west[1] && position[1] < north_east[1];
}

const Route* Network::route(const std::string& name) const {
  const auto found = std::find_if(routes.begin(), routes.end(),
                                  [&](const Route& route) { return route.name == name; });
  return found == routes.end() ? nullptr : &*found;
}

double hectares(const Network& network) {
  const cv::Vec2d extent = network.north_east - network.south_west;
  return extent[0] * extent[1] / 1e4;
}

void add_mouths(Network& network, double least_angle_rad) {
  constexpr double kFirstM = 0.1;
  constexpr double kMouthStepM = 0.5;
  const auto is_bridge = [&](std::size_t a, std::size_t b) {
    return std::any_of(network.bridges.begin(), network.bridges.end(), [&](const Bridge& bridge) {
      return std::minmax(a, b) == std::minmax(bridge.upper, bridge.lower);
    });
  };
  for (std::size_t i = 0; i < network.roads.size(); ++i) {
    const Road& road = network.roads[i];
    for (std::size_t j = 0; j < network.roads.size(); ++j) {
      if (i == j || is_bridge(i, j)) continue;
      const Road& other = network.roads[j];
      const auto is_inside = [&](double along_m) {
        const cv::Vec2d at = road.path.position_at({along_m, 0});
        return std::abs(other.path.place_of(at).lateral_m) < other.half_width_m;
      };
      const auto is_across = [&](double along_m) {
        const double other_m = other.path.place_of(road.path.position_at({along_m, 0})).along_m;
        return std::abs(std::sin(road.path.heading_rad_at(along_m) -
                                 other.path.heading_rad_at(other_m))) >= std::sin(least_angle_rad);
      };
      bool was_inside = is_inside(0);
      for (double along = kFirstM; along < road.path.length_m(); along += kMouthStepM) {
        const bool inside = is_inside(along);
        if (inside != was_inside && is_across(along)) {
          network.mouths.push_back({i, along, inside ? -1.0 : 1.0});
        }
        was_inside = inside;
      }
    }
  }
}

Network make_network(std::uint64_t seed) {
  cv::RNG random = seeded(seed);
  const auto near = [&random](double value, double spread) {
    return value + random.uniform(-spread, spread);
  };
  Network network;
  Terrain& terrain = network.terrain;
  terrain.hill_height_m = near(13, 2);
  terrain.hill_top[1] = near(195, 10);
  terrain.swell_phase = near(0, 3);

  const cv::Vec2d first_crossing(0, near(100, 5));
  const cv::Vec2d second_crossing(0, first_crossing[1] + near(82, 4));
  const cv::Vec2d turn(0, second_crossing[1] + near(36, 3));
  const cv::Vec2d avenue(near(128, 6), near(318, 6));
  const cv::Vec2d ring(near(95, 4), first_crossing[1]);
  const cv::Vec2d corner(ring[0], second_crossing[1]);
  const double crest_east = near(-185, 5);
  const double crest_south = near(185, 5);

  Road main;
  main.name = "main street";
  main.path = Path::through(
      {{{0, -80}}, {turn, near(58, 5)}, {avenue, near(80, 8)}, {{355, avenue[1] + near(0, 6)}}});
  main.half_width_m = 5.6;
  main.parking_m = 2.1;
  main.stretches = {{0, Frontage::canyon}, {310, Frontage::avenue}};
  network.roads.push_back(main);
  const std::vector<Bend> over_the_hill = {{first_crossing},
                                           {{near(-108, 5), first_crossing[1]}, near(55, 5)},
                                           {{crest_east, crest_south}, near(65, 6)},
                                           {{crest_east - near(8, 6), 385}}};
  network.roads.push_back(side_road("hill road", Path::through(over_the_hill),
                                    {{0, Frontage::narrow}, {85, Frontage::open}}));
  const cv::Vec2d ring_west = ring - cv::Vec2d(kRingRadiusM, 0);
  const cv::Vec2d ring_north = ring + cv::Vec2d(0, kRingRadiusM);
  network.roads.push_back(side_road("market lane", Path::through({{first_crossing}, {ring_west}}),
                                    {{0, Frontage::narrow}}));
  network.roads.push_back(side_road("church lane",
                                    Path::through({{ring_north}, {corner, 15}, {second_crossing}}),
                                    {{0, Frontage::narrow}}));
  network.roads.push_back(side_road(
      "east road", Path::through({{ring + cv::Vec2d(kRingRadiusM, 0)}, {{255, ring[1] + 12}}}),
      {{0, Frontage::avenue}, {80, Frontage::open}}));
  network.roads.push_back(side_road(
      "south road", Path::through({{ring - cv::Vec2d(0, kRingRadiusM)}, {{ring[0] + 6, -70}}}),
      {{0, Frontage::avenue}, {90, Frontage::open}}));
  network.roads.push_back(side_road("station road",
                                    Path::through({{{near(238, 6), 235}}, {{near(240, 6), 395}}}),
                                    {{0, Frontage::avenue}}));
  Road circle = side_road("roundabout", Path::circle(ring, kRingRadiusM), {{0, Frontage::avenue}});
  circle.half_width_m = kRingHalfWidthM;
  circle.has_centre_line = false;
  network.roads.push_back(circle);
  add_mouths(network, 0);

  network.routes.push_back({"town-main", main.path, kLaneM, {}});
  network.routes.push_back({"street", main.path, kLaneM, {}});
  std::vector<Bend> hill_bends = over_the_hill;
  hill_bends.front().at[0] = -14;
  network.routes.push_back({"town-hill", Path::through(hill_bends), kLaneM, {}});
  std::vector<Bend> loop = {{{0, first_crossing[1] - 55}}, {first_crossing, 9}};
  for (const Bend& bend : around(ring)) loop.push_back(bend);
  loop.push_back({corner, 13});
  loop.push_back({second_crossing + cv::Vec2d(13, 0)});
  network.routes.push_back({"town-loop", Path::through(loop), kLaneM, {}});

  network.south_west = {-270, -110};
  network.north_east = {390, 410};
  return network;
}

}  // namespace milepost::simulator
