#include "tests/simulator/street.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/simulator/facade.h"
#include "tests/simulator/ground.h"

namespace milepost::simulator {
namespace {

constexpr double kBeforeM = 20;  // of street behind a drive's start
constexpr double kHouseDepthM = 9;
constexpr double kMaxSetbackM = 1.2;  // of houses from the pavement; garden walls stand there
constexpr double kGroundTileM = 4;
constexpr int kGroundTexelsPerM = 40;
constexpr double kGroundReachM = 7.5;  // to either side of the middle line

const Point kUp(0, 0, 1);

// Where the sun stands: a unit vector towards it.
const Point kSun = cv::normalize(Point(0.75, -0.35, 0.6));

// Builds the scene of a street, piece by piece.
class StreetBuilder {
 public:
  explicit StreetBuilder(const StreetPlan& plan)
      : plan_(plan), line_(plan.heading_deg, plan.curvature_per_m), random_(plan.seed) {}

  Street build() && {
    add_ground();
    add_houses(-1);
    add_houses(+1);
    add_last_house();
    add_poles();
    return {plan_, line_, std::move(scene_)};
  }

 private:
  double from_m() const { return -kBeforeM; }
  double to_m() const { return plan_.length_m + plan_.beyond_m; }

  Point point_at(double along_m, double lateral_m, double up_m) const {
    const cv::Vec2d position = line_.position_at({along_m, lateral_m});
    return {position[0], position[1], up_m};
  }

  void add_surface(const Point& top_left, const Point& across, const Point& down, double width_m,
                   double height_m, const std::shared_ptr<const Texture>& texture,
                   const cv::Size& size) {
    const Point normal = across.cross(down);
    const auto lit = static_cast<float>(std::abs(normal.dot(kSun)));
    const cv::Vec2f texels_per_m(static_cast<float>(size.width / width_m),
                                 static_cast<float>(size.height / height_m));
    scene_.surfaces.push_back(
        {top_left, across, down, width_m, height_m, texture, texels_per_m, 0.72F + 0.38F * lit});
  }

  void add_surface(const Point& top_left, const Point& across, const Point& down, double width_m,
                   double height_m, const cv::Mat& image) {
    add_surface(top_left, across, down, width_m, height_m, std::make_shared<Texture>(image),
                image.size());
  }

  // An upright wall whose foot runs from one point to the other, left to right as it is looked at.
  template <class Paint>
  void add_wall(const Point& left, const Point& right, double height_m, Paint paint) {
    const double width_m = cv::norm(right - left);
    add_surface(left + kUp * height_m, (right - left) * (1 / width_m), -kUp, width_m, height_m,
                paint(width_m, height_m, random_));
  }

  // Squares of a grid that is fixed to the local frame, wherever the street needs them.
  void add_ground() {
    std::set<std::pair<int, int>> cells;
    for (double along = from_m(); along <= to_m(); along += kGroundTileM / 4) {
      for (double lateral = -kGroundReachM; lateral <= kGroundReachM; lateral += kGroundTileM / 4) {
        const cv::Vec2d position = line_.position_at({along, lateral});
        cells.emplace(static_cast<int>(std::floor(position[0] / kGroundTileM)),
                      static_cast<int>(std::floor(position[1] / kGroundTileM)));
      }
    }
    const Ground ground(line_, from_m(), to_m(), random_.next());
    for (const auto& [column, row] : cells) {
      const cv::Vec2d north_west(column * kGroundTileM, (row + 1) * kGroundTileM);
      add_surface({north_west[0], north_west[1], 0}, {1, 0, 0}, {0, -1, 0}, kGroundTileM,
                  kGroundTileM, ground.paint(north_west, kGroundTileM, kGroundTexelsPerM));
    }
  }

  // The houses of one side (-1 left, +1 right), with gaps that garden walls close.
  void add_houses(int side) {
    double along = from_m();
    while (along < to_m()) {
      const double width_m = random_.uniform(8.0, 15.0);
      const double setback_m = random_.uniform(0.0, kMaxSetbackM);
      add_house(along, along + width_m, side * (kRoadHalfWidthM + kPavementWidthM + setback_m));
      along += width_m;
      if (random_.uniform(0, 3) == 0) {
        const double gap_m = random_.uniform(2.0, 5.0);
        const double lateral = side * (kRoadHalfWidthM + kPavementWidthM + kMaxSetbackM);
        add_street_wall(along, along + gap_m, lateral, random_.uniform(1.6, 2.4),
                        paint_garden_wall);
        along += gap_m;
      }
    }
  }

  // A wall along the street, its texture the right way round for one who stands on the street.
  template <class Paint>
  void add_street_wall(double near_m, double far_m, double lateral_m, double height_m,
                       Paint paint) {
    const Point near = point_at(near_m, lateral_m, 0);
    const Point far = point_at(far_m, lateral_m, 0);
    if (lateral_m > 0) {
      add_wall(far, near, height_m, paint);
    } else {
      add_wall(near, far, height_m, paint);
    }
  }

  void add_house(double near_m, double far_m, double lateral_m) {
    const double height_m = 3.6 + 3.1 * random_.uniform(1, 4) + random_.uniform(0.2, 1.0);
    const double back_m = lateral_m + (lateral_m > 0 ? kHouseDepthM : -kHouseDepthM);
    add_street_wall(near_m, far_m, lateral_m, height_m, paint_facade);
    for (const double along : {near_m, far_m}) {
      add_wall(point_at(along, lateral_m, 0), point_at(along, back_m, 0), height_m,
               paint_side_wall);
    }
  }

  // A broad house across the street's end closes the view.
  void add_last_house() {
    add_wall(point_at(to_m(), -24, 0), point_at(to_m(), 24, 0), 14, paint_facade);
  }

  void add_poles() {
    int side = 1;
    for (double along = from_m() + 6; along < to_m(); along += random_.uniform(10.0, 16.0)) {
      const double lateral = side * (kRoadHalfWidthM + random_.uniform(0.4, 0.8));
      if (random_.uniform(0, 2) == 0) {
        add_lamp(along, lateral);
      } else {
        add_sign(along, lateral);
      }
      side = -side;
    }
  }

  void add_lamp(double along_m, double lateral_m) {
    constexpr double kHeightM = 6;
    const double inward_m = lateral_m > 0 ? -1.2 : 1.2;
    add_post(along_m, lateral_m, 0.16, 0, kHeightM);
    add_wall(point_at(along_m, lateral_m, kHeightM - 0.12),
             point_at(along_m, lateral_m + inward_m, kHeightM - 0.12), 0.12, paint_pole);
    add_post(along_m, lateral_m + inward_m, 0.4, kHeightM - 0.3, 0.35);
  }

  void add_sign(double along_m, double lateral_m) {
    constexpr double kSideM = 0.7;
    add_post(along_m, lateral_m, 0.1, 0, 2.9);
    add_wall(point_at(along_m - 0.08, lateral_m - kSideM / 2, 2.1),
             point_at(along_m - 0.08, lateral_m + kSideM / 2, 2.1), kSideM,
             [](double width_m, double, cv::RNG& random) {
               return paint_traffic_sign(width_m, random);
             });
  }

  // A square post of four walls.
  void add_post(double along_m, double lateral_m, double side_m, double foot_m, double height_m) {
    const double half = side_m / 2;
    const Point corners[] = {point_at(along_m - half, lateral_m - half, foot_m),
                             point_at(along_m - half, lateral_m + half, foot_m),
                             point_at(along_m + half, lateral_m + half, foot_m),
                             point_at(along_m + half, lateral_m - half, foot_m)};
    for (int i = 0; i < 4; ++i) add_wall(corners[i], corners[(i + 1) % 4], height_m, paint_pole);
  }

  StreetPlan plan_;
  Centreline line_;
  cv::RNG random_;
  Scene scene_;
};

}  // namespace

Street make_street(const StreetPlan& plan) { return StreetBuilder(plan).build(); }

}  // namespace milepost::simulator
