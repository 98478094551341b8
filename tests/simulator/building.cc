#include "tests/simulator/building.h"

#include <algorithm>
#include <cmath>

#include "tests/simulator/facade.h"
#include "tests/simulator/paint.h"
#include "tests/simulator/roof.h"
#include "tests/simulator/solids.h"

namespace milepost::simulator {
namespace {

constexpr double kOverhangM = 0.4;
constexpr double kParapetM = 0.7;

class Builder {
 public:
  Builder(Scene& scene, const Building& building)
      : scene_(scene), of_(building), random_(seeded(building.seed)) {
    for (int i = 0; i < 4; ++i) {
      corner_[i] = {of_.footprint[i][0], of_.footprint[i][1], of_.ground_m};
    }
    across_ = cv::normalize(corner_[1] - corner_[0]);
    inwards_ = cv::normalize(corner_[3] - corner_[0]);
    width_m_ = cv::norm(corner_[1] - corner_[0]);
    depth_m_ = cv::norm(corner_[3] - corner_[0]);
  }

  void build() {
    for (int side = 0; side < 4; ++side) add_wall_of(side);
    switch (of_.roof) {
      case Roof::gable:
        add_gable_roof(corner_[0], across_, width_m_, inwards_, depth_m_);
        break;
      case Roof::gable_to_street:
        add_gable_roof(corner_[3], -inwards_, depth_m_, across_, width_m_);
        break;
      case Roof::hip:
        add_hip_roof();
        break;
      case Roof::flat:
        add_flat_roof();
        break;
    }
    if (of_.roof != Roof::flat) add_chimneys();
    if (of_.frontage != Frontage::open) add_front_fittings();
  }

 private:
  bool has_gable(int side) const {
    return (of_.roof == Roof::gable && side % 2 == 1) ||
           (of_.roof == Roof::gable_to_street && side % 2 == 0);
  }

  void add_wall_of(int side) {
    const Point& left = corner_[side];
    const Point& right = corner_[(side + 1) % 4];
    const bool is_front = side == 0;
    const double extra_m = has_gable(side) ? of_.ridge_m : of_.roof == Roof::flat ? kParapetM : 0;
    const WallSize size{cv::norm(right - left), of_.eaves_m + extra_m,
                        is_front ? kNearTexelsPerM : kFarTexelsPerM};
    const bool has_shops = of_.frontage == Frontage::canyon || of_.frontage == Frontage::narrow;
    const auto texture = painted(
        [=](cv::RNG& random) {
          return is_front ? paint_facade(size, has_shops, random) : paint_side_wall(size, random);
        },
        of_.seed * 8 + static_cast<std::uint64_t>(side));
    const Point across = (right - left) * (1 / size.width_m);
    const double wall_m = has_gable(side) ? of_.eaves_m : size.height_m;
    const TextureMap map{left + kUp * size.height_m, across * size.texels_per_m,
                         -kUp * size.texels_per_m};
    const Point low = -kUp * of_.foundation_m;
    scene_.surfaces.push_back(polygon(
        {left + kUp * wall_m, right + kUp * wall_m, right + low, left + low}, texture, map));
    if (has_gable(side)) {
      const Point top = (left + right) * 0.5 + kUp * size.height_m;
      scene_.surfaces.push_back(
          polygon({left + kUp * wall_m, top, right + kUp * wall_m}, texture, map));
    }
  }

  void add_roof_piece(const std::vector<Point>& corners, const Point& along,
                      const std::shared_ptr<const Texture>& texture) {
    Surface piece = polygon(corners, texture, {});
    if (piece.normal[2] < 0) piece.normal = -piece.normal;
    const Point down = along.cross(piece.normal);
    piece.map = {corners[0], along * kRoofTexelsPerM,
                 (down[2] < 0 ? down : -down) * kRoofTexelsPerM};
    scene_.surfaces.push_back(piece);
  }

  std::shared_ptr<const Texture> tiles(double width_m, double height_m) {
    const std::uint64_t seed = of_.seed * 8 + 5;
    return painted([=](cv::RNG& random) { return paint_tiles(width_m, height_m, random); }, seed);
  }

  // The ridge runs along `along`, from above `start` + `out` * depth / 2.
  void add_gable_roof(const Point& start, const Point& along, double length_m, const Point& out,
                      double depth_m) {
    const double drop_m = of_.ridge_m * kOverhangM / (depth_m / 2);
    const double slope_m = std::hypot(depth_m / 2, of_.ridge_m) + 1;
    const auto texture = tiles(length_m + 2 * kOverhangM, slope_m);
    const Point ridge = start + out * (depth_m / 2) + kUp * (of_.eaves_m + of_.ridge_m);
    const Point from = -along * (kOverhangM / 2);
    const Point to = along * (length_m + kOverhangM / 2);
    for (const double side : {-1.0, 1.0}) {
      const Point eave =
          ridge + out * (side * (depth_m / 2 + kOverhangM)) - kUp * (of_.ridge_m + drop_m);
      add_roof_piece({ridge + from, ridge + to, eave + to, eave + from}, along, texture);
    }
  }

  void add_hip_roof() {
    const double inset_m = std::min(width_m_, depth_m_) / 2;
    const bool is_wide = width_m_ >= depth_m_;
    const Point middle = (corner_[0] + corner_[2]) * 0.5 + kUp * (of_.eaves_m + of_.ridge_m);
    const Point along = is_wide ? across_ : inwards_;
    const double half_m = std::max(width_m_, depth_m_) / 2 - inset_m + 0.2;
    const Point ends[2] = {middle - along * half_m, middle + along * half_m};
    const double drop_m = of_.ridge_m * kOverhangM / inset_m;
    std::array<Point, 4> eave;
    const Point centre = (corner_[0] + corner_[2]) * 0.5;
    for (int i = 0; i < 4; ++i) {
      const Point out = corner_[i] - centre;
      const double x = out.dot(across_) > 0 ? 1 : -1;
      const double y = out.dot(inwards_) > 0 ? 1 : -1;
      eave[i] =
          corner_[i] + (across_ * x + inwards_ * y) * kOverhangM + kUp * (of_.eaves_m - drop_m);
    }
    const auto texture = tiles(std::max(width_m_, depth_m_) + 1, inset_m + of_.ridge_m + 1);
    for (int side = 0; side < 4; ++side) {
      const Point& left = eave[side];
      const Point& right = eave[(side + 1) % 4];
      const Point run = cv::normalize(right - left);
      const bool is_long = (side % 2 == 0) == is_wide;
      if (is_long) {
        const bool same = run.dot(along) > 0;
        add_roof_piece({ends[same ? 0 : 1], ends[same ? 1 : 0], right, left}, run, texture);
      } else {
        const bool is_near_first = cv::norm(left - ends[0]) < cv::norm(left - ends[1]);
        add_roof_piece({ends[is_near_first ? 0 : 1], right, left}, run, texture);
      }
    }
  }

  void add_flat_roof() {
    const double width = width_m_;
    const double depth = depth_m_;
    const auto texture = painted(
        [=](cv::RNG& random) { return paint_flat_roof(width, depth, random); }, of_.seed * 8 + 6);
    const Point top = kUp * of_.eaves_m;
    add_roof_piece({corner_[0] + top, corner_[1] + top, corner_[2] + top, corner_[3] + top},
                   across_, texture);
    scene_.surfaces.back().map = {corner_[3] + top, across_ * kRoofTexelsPerM,
                                  -inwards_ * kRoofTexelsPerM};
    const int count = random_.uniform(2, 6);
    for (int i = 0; i < count; ++i) {
      const Point place = corner_[0] + across_ * random_.uniform(1.5, width_m_ - 1.5) +
                          inwards_ * random_.uniform(1.5, depth_m_ - 1.5) + top;
      add_fitting(place, random_.uniform(0.6, 2.6), random_.uniform(0.6, 2.2),
                  random_.uniform(0.4, 1.9), false);
    }
  }

  // A box in line with the house: a chimney, a ventilator.
  void add_fitting(const Point& place, double length_m, double width_m, double height_m,
                   bool is_brick) {
    const double size_m = std::max(length_m, width_m);
    const auto texture = painted(
        [=](cv::RNG& random) {
          return is_brick ? paint_brick(size_m, height_m, kFarTexelsPerM, random)
                          : paint_metal(size_m, height_m, kFarTexelsPerM, random);
        },
        random_.next());
    const cv::Vec2d along(across_[0], across_[1]);
    add_box(scene_, {place, along, length_m, width_m, height_m}, texture, kFarTexelsPerM);
  }

  void add_chimneys() {
    const int count = random_.uniform(0, 3);
    for (int i = 0; i < count; ++i) {
      const Point place = corner_[0] + across_ * (width_m_ * random_.uniform(0.15, 0.85)) +
                          inwards_ * (depth_m_ * random_.uniform(0.4, 0.6)) +
                          kUp * (of_.eaves_m + of_.ridge_m * 0.6);
      add_fitting(place, random_.uniform(0.5, 1.2), 0.55, of_.ridge_m * 0.4 + 0.9, true);
    }
  }

  void add_front_fittings() {
    const bool has_shops = of_.frontage == Frontage::canyon || of_.frontage == Frontage::narrow;
    if (has_shops && random_.uniform(0, 2) == 0) add_awning();
    if (has_shops && random_.uniform(0, 3) > 0) add_board();
    if (of_.eaves_m > 7 && width_m_ > 7) {
      const int kind = random_.uniform(0, 4);
      if (kind == 0) add_oriel();
      if (kind == 1) add_balconies();
    }
  }

  void add_awning() {
    constexpr double kFallM = 0.55;
    constexpr double kReachM = 1.25;
    const double width_m = random_.uniform(2.2, 3.4);
    const double from_m = random_.uniform(0.4, std::max(0.5, width_m_ - width_m - 0.4));
    const Point left = corner_[0] + across_ * from_m + kUp * 3.0;
    const Point right = left + across_ * width_m;
    const Point out = -inwards_ * kReachM - kUp * kFallM;
    const double slope_m = std::hypot(kReachM, kFallM);
    const auto texture = painted(
        [=](cv::RNG& random) { return paint_awning(width_m, slope_m, kNearTexelsPerM, random); },
        random_.next());
    scene_.surfaces.push_back(
        polygon({left, right, right + out, left + out}, texture,
                {left, across_ * kNearTexelsPerM, cv::normalize(out) * kNearTexelsPerM}));
  }

  // A board at a right angle to the wall.
  void add_board() {
    const double width_m = random_.uniform(0.6, 1.0);
    const double height_m = random_.uniform(0.5, 1.3);
    const Point foot = corner_[0] + across_ * random_.uniform(0.3, width_m_ - 0.3) +
                       kUp * random_.uniform(2.7, 3.4);
    const auto texture = painted(
        [=](cv::RNG& random) { return paint_board(width_m, height_m, kNearTexelsPerM, random); },
        random_.next());
    const WallSize size{width_m, height_m};
    const Point outer = foot - inwards_ * (width_m + 0.15);
    const Point inner = foot - inwards_ * 0.15;
    // Which end is left depends on the viewing side: it faces both directions of the street.
    add_wall(scene_, inner, outer, height_m, texture, size.texels());
    add_wall(scene_, outer + across_ * 0.06, inner + across_ * 0.06, height_m, texture,
             size.texels());
  }

  void add_oriel() {
    constexpr double kOutM = 0.75;
    const double width_m = random_.uniform(2.4, 3.2);
    const double from_m = random_.uniform(0.5, width_m_ - width_m - 0.5);
    const double height_m = of_.eaves_m - 3.6 - random_.uniform(0.0, 0.8);
    const Point left = corner_[0] + across_ * from_m + kUp * 3.5;
    const Point right = left + across_ * width_m;
    const Point out = -inwards_ * kOutM;
    const WallSize size{width_m, height_m};
    const std::uint64_t seed = random_.next();
    const auto front = painted([=](cv::RNG& random) { return paint_oriel(size, random); }, seed);
    add_wall(scene_, left + out, right + out, height_m, front, size.texels());
    const WallSize narrow{kOutM, height_m};
    const auto cheek = painted([=](cv::RNG& random) { return paint_pole(narrow, random); }, seed);
    add_wall(scene_, left, left + out, height_m, cheek, narrow.texels());
    add_wall(scene_, right + out, right, height_m, cheek, narrow.texels());
    for (const double up : {0.0, height_m}) {
      scene_.surfaces.push_back(polygon(
          {left + kUp * up, right + kUp * up, right + out + kUp * up, left + out + kUp * up}, cheek,
          {left, across_ * 10, out * 10}));
    }
  }

  void add_balconies() {
    constexpr double kOutM = 1.1;
    const double width_m = random_.uniform(2.0, 3.2);
    const double from_m = random_.uniform(0.4, width_m_ - width_m - 0.4);
    const WallSize rail{width_m, 1.0};
    const auto railing = painted(
        [=](cv::RNG& random) { return paint_railing(width_m, 1.0, kNearTexelsPerM, random); },
        random_.next());
    const auto slab = painted(
        [=](cv::RNG& random) {
          return paint_pole({width_m, kOutM}, random);
        },
        random_.next());
    const cv::Vec2d along(across_[0], across_[1]);
    for (double up = 3.7; up + 2.6 < of_.eaves_m; up += 3.1) {
      const Point left = corner_[0] + across_ * from_m + kUp * up;
      const Point right = left + across_ * width_m;
      const Point out = -inwards_ * kOutM;
      add_box(scene_, {(left + right + out) * 0.5, along, width_m, kOutM, 0.16}, slab,
              kNearTexelsPerM);
      scene_.surfaces.push_back(
          polygon({left, right, right + out, left + out}, slab, {left, across_ * 30, out * 30}));
      for (const auto& [a, b] : {std::pair{left + out, right + out}, std::pair{left, left + out},
                                 std::pair{right + out, right}}) {
        add_wall(scene_, a + kUp * 0.16, b + kUp * 0.16, 1.0, railing, rail.texels());
        scene_.surfaces.back().map.u_per_m =
            cv::normalize(scene_.surfaces.back().map.u_per_m) * kNearTexelsPerM;
        scene_.surfaces.back().is_cut_out = true;
      }
    }
  }

  Scene& scene_;
  const Building& of_;
  cv::RNG random_;
  std::array<Point, 4> corner_;
  Point across_, inwards_;
  double width_m_ = 0;
  double depth_m_ = 0;
};

}  // namespace

void add_building(Scene& scene, const Building& building) { Builder(scene, building).build(); }

}  // namespace milepost::simulator
