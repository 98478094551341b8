#include "tests/simulator/ground.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "tests/simulator/paint.h"

namespace milepost::simulator {
namespace {

const cv::Vec3f kMarking(205, 212, 213);
const cv::Vec3f kKerb(150, 155, 157);
constexpr double kCrossingM = 3.2;     // length of a zebra crossing along the road
constexpr double kCrossingGapM = 3.0;  // from the junction
constexpr double kManholeRadiusM = 0.33;
constexpr double kCornerM = 5;  // radius of kerbs at junctions
constexpr double kReachM = 30;  // distance within which a road is considered

bool is_inside(double value, double from, double to) { return value >= from && value < to; }

// The phase in a period, [0, period).
double phase(double value, double period) { return value - std::floor(value / period) * period; }

// A smooth minimum, rounded where the two are within `width` of each other.
double smooth_min(double a, double b, double width) {
  const double h = std::max(width - std::abs(a - b), 0.0) / width;
  return std::min(a, b) - h * h * width / 4;
}

// An arrow that points along +along from its tail, 4 m long.
bool is_arrow(double along_m, double lateral_m) {
  if (is_inside(along_m, 0, 2.6)) return std::abs(lateral_m) < 0.08;
  return is_inside(along_m, 2.6, 4) && std::abs(lateral_m) < 0.32 * (4 - along_m) / 1.4;
}

}  // namespace

Ground::Ground(const Network& network, std::uint64_t seed)
    : network_(network), seed_(seed), fittings_(network.roads.size()) {
  cv::RNG random = seeded(seed);
  for (std::size_t i = 0; i < network_.roads.size(); ++i) {
    const Road& road = network_.roads[i];
    Fittings& fittings = fittings_[i];
    const double length = road.path.length_m();
    const double side = road.half_width_m;
    for (double along = 0; along < length; along += random.uniform(2.5, 9.0)) {
      fittings.repairs.push_back({{along, random.uniform(-side, side - 1.2)},
                                  random.uniform(0.6, 6.0),
                                  random.uniform(0.4, 1.7),
                                  random.uniform(-20.0F, 14.0F)});
    }
    for (double along = 0; along < length; along += random.uniform(9.0, 24.0)) {
      fittings.manholes.push_back({along, random.uniform(-side + 0.6, side - 0.6)});
    }
  }
  for (const Mouth& mouth : network_.mouths) {
    const Road& road = network_.roads[mouth.road];
    if (road.name == "roundabout") continue;
    Fittings& fittings = fittings_[mouth.road];
    const double near = mouth.along_m + mouth.outwards * kCrossingGapM;
    fittings.crossings.push_back(mouth.outwards > 0 ? near : near - kCrossingM);
    const double stop = mouth.along_m + mouth.outwards * (kCrossingGapM + kCrossingM + 1.2);
    fittings.stop_alongs.push_back(stop);
    fittings.stop_lines.push_back(-mouth.outwards);  // for traffic towards the junction
    fittings.arrows.push_back({stop + mouth.outwards * 10, -mouth.outwards * kLaneM});
  }
}

std::vector<std::size_t> Ground::roads_near(const cv::Vec2d& middle, double side_m) const {
  std::vector<std::size_t> roads;
  for (std::size_t i = 0; i < network_.roads.size(); ++i) {
    const double distance = std::abs(network_.roads[i].path.place_of(middle).lateral_m);
    if (distance < kReachM + side_m) roads.push_back(i);
  }
  return roads;
}

cv::Mat Ground::paint(const cv::Vec2d& north_west, double side_m, int texels_per_m) const {
  const cv::Vec2d middle = north_west + cv::Vec2d(side_m / 2, -side_m / 2);
  std::vector<std::size_t> roads = roads_near(middle, side_m);
  for (const Bridge& bridge : network_.bridges) {
    if (bridge.is_over(middle)) std::erase(roads, bridge.upper);
  }
  return paint(north_west, side_m, texels_per_m, roads);
}

cv::Mat Ground::paint_deck(const Bridge& bridge, const cv::Vec2d& north_west, double side_m,
                           int texels_per_m) const {
  const cv::Vec2d middle = north_west + cv::Vec2d(side_m / 2, -side_m / 2);
  std::vector<std::size_t> roads = roads_near(middle, side_m);
  std::erase(roads, bridge.lower);
  return paint(north_west, side_m, texels_per_m, roads);
}

cv::Mat Ground::paint(const cv::Vec2d& north_west, double side_m, int texels_per_m,
                      const std::vector<std::size_t>& roads) const {
  const int side = static_cast<int>(std::lround(side_m * texels_per_m));
  cv::Mat image(side, side, CV_8UC3);
  for (int row = 0; row < side; ++row) {
    const double north_m = north_west[1] - (row + 0.5) / texels_per_m;
    for (int column = 0; column < side; ++column) {
      const double east_m = north_west[0] + (column + 0.5) / texels_per_m;
      image.at<cv::Vec3b>(row, column) = colour_at({east_m, north_m}, roads);
    }
  }
  cv::GaussianBlur(image, image, {}, 0.7);  // softens grains and the steps of slanted edges
  return image;
}

cv::Vec3f Ground::colour_at(const cv::Vec2d& position,
                            const std::vector<std::size_t>& roads) const {
  constexpr double kGrainsPerM = 40;
  const double east = position[0];
  const double north = position[1];
  const float fine =
      lattice_noise(static_cast<std::int64_t>(std::floor(east * kGrainsPerM)),
                    static_cast<std::int64_t>(std::floor(north * kGrainsPerM)), seed_ + 1) -
      0.5F;
  const float coarse = smooth_noise(east * 5, north * 5, seed_ + 2) - 0.5F;
  const float wide = smooth_noise(east * 0.7, north * 0.7, seed_ + 3) - 0.5F;
  const float grain = 40 * fine + 16 * coarse + 22 * wide;
  Near nearest{0, {}, 1e9};
  double others_m = 1e9;  // to the edge of the second nearest road
  double beyond_m = 1e9;  // to the edge of all, corners rounded
  for (const std::size_t i : roads) {
    const Road& road = network_.roads[i];
    const RoadPlace place = road.path.place_of(position);
    const double edge_m = std::abs(place.lateral_m) - road.half_width_m;
    beyond_m = beyond_m > 1e8 ? edge_m : smooth_min(beyond_m, edge_m, kCornerM);
    if (edge_m < nearest.beyond_edge_m) {
      others_m = nearest.beyond_edge_m;
      nearest = {i, place, edge_m};
    } else {
      others_m = std::min(others_m, edge_m);
    }
  }
  if (roads.empty()) return yard_colour(position, Frontage::open, kReachM, grain);
  if (beyond_m < 0) return road_colour(nearest, others_m, beyond_m, position, grain);
  const Frontage frontage = network_.roads[nearest.road].frontage_at(nearest.place.along_m);
  if (frontage == Frontage::open) {
    const double ragged = 0.7 + 0.5 * smooth_noise(east * 1.5, north * 1.5, seed_ + 6);
    if (beyond_m < ragged) return cv::Vec3f(122, 134, 142) + cv::Vec3f::all(grain * 1.4F);
  } else if (beyond_m < kKerbM + pavement_width_m(frontage)) {
    return pavement_colour(nearest, beyond_m, grain);
  }
  return yard_colour(position, frontage, beyond_m, grain);
}

cv::Vec3f Ground::road_colour(const Near& near, double others_m, double beyond_m,
                              const cv::Vec2d& position, float grain) const {
  const RoadPlace& place = near.place;
  const Fittings& fittings = fittings_[near.road];
  for (const RoadPlace& manhole : fittings.manholes) {
    const double along = place.along_m - manhole.along_m;
    if (std::abs(along) > kManholeRadiusM) continue;
    if (std::hypot(along, place.lateral_m - manhole.lateral_m) < kManholeRadiusM) {
      const bool is_rib = phase(place.along_m, 0.12) < 0.05 || phase(place.lateral_m, 0.12) < 0.05;
      return cv::Vec3f::all((is_rib ? 92.0F : 55.0F) + grain / 3);
    }
  }
  if (is_marking(near, others_m)) {
    const float worn = smooth_noise(position[0] * 4, position[1] * 4, seed_ + 7);
    if (worn < 0.82F) return kMarking - cv::Vec3f::all(45 * worn) + cv::Vec3f::all(grain * 0.6F);
  }
  float shade = 88 + grain;
  const double edge = std::max(-beyond_m, 0.0);
  if (edge < 0.35) shade -= static_cast<float>(22 * (1 - edge / 0.35));  // the gutter
  for (const Repair& repair : fittings.repairs) {
    const double along = place.along_m - repair.place.along_m;
    const double lateral = place.lateral_m - repair.place.lateral_m;
    if (!is_inside(along, 0, repair.length_m) || !is_inside(lateral, 0, repair.width_m)) continue;
    const double rim =
        std::min({along, lateral, repair.length_m - along, repair.width_m - lateral});
    shade += rim < 0.05 ? -34 : repair.shade;
  }
  // Wheels polish their tracks and oil drips between them.
  const double in_lane = std::abs(place.lateral_m) - kLaneM;
  shade += std::abs(std::abs(in_lane) - 0.75) < 0.3 ? 4.0F : 0.0F;
  shade -= std::abs(in_lane) < 0.3 ? 5.0F : 0.0F;
  // Cracks, filled with tar.
  const float crack = smooth_noise(position[0] * 0.45, position[1] * 0.45, seed_ + 8) +
                      0.12F * smooth_noise(position[0] * 3, position[1] * 3, seed_ + 9);
  if (std::abs(crack - 0.56F) < 0.0045F) shade -= 36;
  return {shade * 1.02F, shade, shade * 0.985F};
}

bool Ground::is_marking(const Near& near, double others_m) const {
  if (others_m < 1.0) return false;  // inside a junction
  const Road& road = network_.roads[near.road];
  const Fittings& fittings = fittings_[near.road];
  const auto [along, lateral] = near.place;
  const double lane_edge_m = road.half_width_m - road.parking_m;
  for (const double crossing : fittings.crossings) {
    if (is_inside(along, crossing, crossing + kCrossingM)) {
      return phase(lateral, 1.0) < 0.5 && std::abs(lateral) < road.half_width_m - 0.3;
    }
  }
  for (std::size_t i = 0; i < fittings.stop_alongs.size(); ++i) {
    if (std::abs(along - fittings.stop_alongs[i]) < 0.25 &&
        is_inside(lateral * fittings.stop_lines[i], 0.1, lane_edge_m - 0.1)) {
      return true;
    }
  }
  for (const RoadPlace& arrow : fittings.arrows) {
    const double towards = arrow.lateral_m > 0 ? 1 : -1;
    if (is_arrow((along - arrow.along_m) * towards, lateral - arrow.lateral_m)) return true;
  }
  const double side = std::abs(lateral);
  if (road.parking_m > 0) {
    if (is_inside(side, lane_edge_m - 0.06, lane_edge_m + 0.06) && phase(along, 1) < 0.6)
      return true;
    if (side > lane_edge_m && phase(along, 6) < 0.1) return true;
  } else if (is_inside(side, road.half_width_m - 0.42, road.half_width_m - 0.3)) {
    return true;
  }
  return road.has_centre_line && side < 0.07 && phase(along, 9) < 3;
}

cv::Vec3f Ground::pavement_colour(const Near& near, double beyond_m, float grain) const {
  const RoadPlace& place = near.place;
  if (beyond_m < kKerbM) {
    const bool is_joint = phase(place.along_m, 1.0) < 0.03 || beyond_m < 0.03;
    return is_joint ? cv::Vec3f::all(62) : kKerb + cv::Vec3f::all(grain * 0.7F);
  }
  const double slab_m = near.road % 2 == 0 ? 0.5 : 0.4;
  const auto row = static_cast<std::int64_t>(std::floor(beyond_m / slab_m));
  const double shifted = place.along_m + (row % 2 == 0 ? 0 : slab_m / 2);
  if (phase(shifted, slab_m) < 0.025 || phase(beyond_m, slab_m) < 0.025) {
    return cv::Vec3f::all(84 + grain * 0.4F);
  }
  const auto slab = static_cast<std::int64_t>(std::floor(shifted / slab_m));
  const float tone = 34 * (lattice_noise(slab, row * 2 + (place.lateral_m > 0), seed_ + 4) - 0.5F);
  const float shade = 130 + tone + grain * 0.8F;
  return {shade * 0.95F, shade * 0.985F, shade};
}

cv::Vec3f Ground::yard_colour(const cv::Vec2d& position, Frontage frontage, double beyond_m,
                              float grain) const {
  const double east = position[0];
  const double north = position[1];
  const float lush = smooth_noise(east / 9, north / 9, seed_ + 10);
  const float blades = smooth_noise(east * 14, north * 14, seed_ + 11) +
                       smooth_noise(east * 33, north * 33, seed_ + 12) - 1;
  const float tuft = smooth_noise(east * 1.7, north * 1.7, seed_ + 13) - 0.5F;
  const float paved = frontage == Frontage::canyon || frontage == Frontage::narrow ? 0.62F
                      : frontage == Frontage::avenue                               ? 0.22F
                                                                                   : 0.0F;
  const float kind = smooth_noise(east / 12, north / 12, seed_ + 14) +
                     0.1F * smooth_noise(east, north, seed_ + 15);
  const auto reached = static_cast<float>(std::clamp((kReachM - beyond_m) / 8, 0.0, 1.0));
  if (kind < paved * reached) {  // gravel and worn concrete
    const float shade = 128 + grain * 1.2F + 20 * tuft;
    return {shade * 0.93F, shade * 0.98F, shade};
  }
  // Grass, here fresh, there dry; mown strips and trodden earth.
  const float dry = smooth_noise(east / 23, north / 31, seed_ + 16);
  const float light = 0.84F + 0.2F * lush + 0.34F * blades + 0.32F * tuft;
  const cv::Vec3f fresh(44, 92, 74);
  const cv::Vec3f straw(72, 118, 122);
  const cv::Vec3f earth(78, 98, 112);
  cv::Vec3f colour = fresh + (straw - fresh) * (0.25F + 0.75F * dry * dry);
  const float bare = smooth_noise(east / 2.3, north / 2.3, seed_ + 17);
  if (bare > 0.8F) colour += (earth - colour) * std::min((bare - 0.8F) * 6, 0.8F);
  return colour * light + cv::Vec3f::all(grain * 0.3F);
}

}  // namespace milepost::simulator
