// Placement of houses along the roads of a network, clear of every road and of each other.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/simulator/building.h"
#include "tests/simulator/network.h"

namespace milepost::simulator {

// Metres from a position to the nearest edge of a road, including its pavement; negative on it.
double clearance_m(const Network& network, const cv::Vec2d& position);

// Whether two convex outlines intersect.
bool overlaps(const std::array<cv::Vec2d, 4>& a, const std::array<cv::Vec2d, 4>& b);

std::vector<Building> make_buildings(const Network& network, std::uint64_t seed);

}  // namespace milepost::simulator
