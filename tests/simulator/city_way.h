// A drive's way through a city: from a list of turns to passes over edges, and to a driven line.
#pragma once

#include <string>
#include <vector>

#include "tests/simulator/city.h"

namespace milepost::simulator {

// The edges between junctions that are named in order, separated by spaces. Where several edges
// join two junctions, the edge is named too, between them: "quay-split upper-quay.1+ quay-join". A
// number before a junction's name is that of extra rounds: "1*ring".
// REQUIRES: there is such a way.
std::vector<Pass> passes_through(const City& city, const std::string& turns);

// Whether a vehicle can change from lane to lane and back on the edge, on straight stretches.
bool has_room_for_lane_changes(const Edge& edge);

// The line that the drive's vehicle follows, with a span for each edge's lane and each junction.
Route route_of(const City& city, const CityDrive& drive);

}  // namespace milepost::simulator
