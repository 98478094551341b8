// Cars, vans and trucks.
#pragma once

#include <memory>

#include "tests/simulator/render.h"
#include "tests/simulator/scene.h"

namespace milepost::simulator {

enum class VehicleKind { hatchback, saloon, van, truck };

// The appearance of one vehicle; generated once, placed anywhere.
class Vehicle {
 public:
  Vehicle(VehicleKind kind, std::uint64_t seed);

  double length_m() const;
  double width_m() const;
  double height_m() const;

  // Adds its surfaces, with the middle of its floor at `centre`.
  void add_to(std::vector<Surface>& surfaces, const Point& centre, const cv::Vec2d& forward) const;
  Shade shade(const Point& centre, const cv::Vec2d& forward) const;

 private:
  VehicleKind kind_;
  std::shared_ptr<const Texture> side_, front_, back_, top_, glass_, underneath_;
};

}  // namespace milepost::simulator
