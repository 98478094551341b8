#include "tests/simulator/bridge.h"

#include <algorithm>
#include <memory>

#include "tests/simulator/facade.h"
#include "tests/simulator/ground.h"
#include "tests/simulator/paint.h"
#include "tests/simulator/solids.h"

namespace milepost::simulator {
namespace {

constexpr double kDeckPieceM = 4;  // its surface follows the ground's swells
constexpr double kDeckTextureM = 16;
constexpr double kPavementM = 1.9;  // from the carriageway's edge to the parapet
constexpr double kThicknessM = 0.7;
constexpr double kBridgeParapetM = 1.05;
constexpr double kParapetWidthM = 0.25;
constexpr double kPierM = 7;  // of the piers' faces from the middle of the road below
constexpr double kPierWidthM = 0.8;
constexpr float kBelowOpenness = 0.45F;

// One bridge, whose road runs from south to north.
class BridgeBuilder {
 public:
  BridgeBuilder(Scene& scene, const Network& network, const Bridge& bridge, std::uint64_t seed)
      : scene_(scene),
        network_(network),
        bridge_(bridge),
        random_(seeded(seed ^ 0xb41d9e)),
        middle_east_(
            network.roads[bridge.upper].path.position_at(network.roads[bridge.upper].path.place_of(
                (bridge.south_west + bridge.north_east) * 0.5))[0]),
        half_m_(network.roads[bridge.upper].half_width_m + kPavementM) {}

  void build(const std::shared_ptr<const Ground>& ground, int texels_per_m) {
    const double south = bridge_.south_west[1];
    const double north = bridge_.north_east[1];
    for (double from = south; from < north; from += kDeckTextureM) {
      add_surface(ground, from, std::min(from + kDeckTextureM, north), texels_per_m);
    }
    for (double from = south; from < north; from += kDeckPieceM) {
      for (const int side : {-1, 1}) add_edge(from, from + kDeckPieceM, side);
      add_underside(from, from + kDeckPieceM);
    }
    const double middle = (south + north) / 2;
    for (const int side : {-1, 1}) add_pier(middle + side * (kPierM + kPierWidthM / 2));
  }

 private:
  Point deck_at(double east, double north, double above_m = 0) const {
    return {east, north, network_.terrain.uncut_height_m({middle_east_, north}) + above_m};
  }

  // The carriageway and its pavements, with one texture.
  void add_surface(const std::shared_ptr<const Ground>& ground, double south, double north,
                   int texels_per_m) {
    const cv::Vec2d corner(middle_east_ - kDeckTextureM / 2, south + kDeckTextureM);
    const auto texture = std::make_shared<Texture>([=, bridge = bridge_] {
      return ground->paint_deck(bridge, corner, kDeckTextureM, texels_per_m);
    });
    const auto scale = static_cast<double>(texels_per_m);
    const TextureMap map{{corner[0], corner[1], 0}, {scale, 0, 0}, {0, -scale, 0}};
    const double west = middle_east_ - half_m_;
    const double east = middle_east_ + half_m_;
    for (double from = south; from < north; from += kDeckPieceM) {
      const double to = from + kDeckPieceM;
      scene_.surfaces.push_back(
          polygon({deck_at(west, to), deck_at(east, to), deck_at(east, from), deck_at(west, from)},
                  texture, map));
    }
  }

  // A parapet above the deck and the deck's side below it.
  void add_edge(double south, double north, int side) {
    const double east = middle_east_ + side * (half_m_ + kParapetWidthM / 2);
    const WallSize size{north - south, kBridgeParapetM + kThicknessM};
    const auto texture =
        painted([=](cv::RNG& own) { return paint_garden_wall(size, own); }, random_.next());
    const Point foot = deck_at(east, (south + north) / 2, -kThicknessM);
    add_box(scene_, {foot, {0, 1}, size.width_m, kParapetWidthM, size.height_m}, texture,
            size.texels_per_m);
  }

  void add_underside(double south, double north) {
    const WallSize size{2 * half_m_, north - south, kFarTexelsPerM};
    const auto texture = painted(
        [=](cv::RNG& own) {
          cv::Mat image(size.texels(), CV_8UC3, cv::Scalar(118, 124, 126));
          weather(image, 9, 26, own);
          return image;
        },
        random_.next());
    Surface below = polygon(
        {deck_at(middle_east_ - half_m_, south, -kThicknessM),
         deck_at(middle_east_ + half_m_, south, -kThicknessM),
         deck_at(middle_east_ + half_m_, north, -kThicknessM),
         deck_at(middle_east_ - half_m_, north, -kThicknessM)},
        texture,
        {deck_at(middle_east_ - half_m_, south), {kFarTexelsPerM, 0, 0}, {0, kFarTexelsPerM, 0}});
    below.openness = kBelowOpenness;
    scene_.surfaces.push_back(below);
  }

  // A wall along the road below.
  void add_pier(double north) {
    constexpr double kUndergroundM = 0.4;
    const cv::Vec2d at(middle_east_, north);
    const double floor_m = network_.terrain.height_m(at) - kUndergroundM;
    const double height_m = deck_at(at[0], at[1])[2] - kThicknessM - floor_m;
    const WallSize size{2 * half_m_, height_m};
    const auto texture =
        painted([=](cv::RNG& own) { return paint_garden_wall(size, own); }, random_.next());
    const std::size_t first = scene_.surfaces.size();
    add_box(scene_, {{at[0], at[1], floor_m}, {1, 0}, size.width_m, kPierWidthM, height_m}, texture,
            size.texels_per_m);
    for (std::size_t i = first; i < scene_.surfaces.size(); ++i) {
      scene_.surfaces[i].openness = kBelowOpenness;
    }
  }

  Scene& scene_;
  const Network& network_;
  const Bridge& bridge_;
  cv::RNG random_;
  double middle_east_, half_m_;
};

}  // namespace

void add_bridges(Scene& scene, const Network& network, std::uint64_t ground_seed,
                 int texels_per_m) {
  if (network.bridges.empty()) return;
  const auto ground = std::make_shared<Ground>(network, ground_seed);
  for (const Bridge& bridge : network.bridges) {
    BridgeBuilder(scene, network, bridge, ground_seed).build(ground, texels_per_m);
  }
}

}  // namespace milepost::simulator
