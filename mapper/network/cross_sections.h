// Which passes of which ways run side by side, metre by metre.
#pragma once

#include <vector>

#include "mapper/network/alignment.h"
#include "mapper/network/way.h"

namespace milepost {

// For each state of each way, the places on the same road's cross-section: its own, those that are
// on one road with it, those on one road with these, and so on. So the lanes of a wide road are one
// road through those between them, and a lane that parts does so when it has left the nearest.
// Memory is linear in the metres of all alignments.
class CrossSections {
 public:
  // `ways` must outlive this. `same` as by same_road.
  CrossSections(const std::vector<Way>& ways, const std::vector<Alignment>& same);

  // Ordered; contains the place itself. A way has several places if it passes the road repeatedly.
  std::vector<Place> places(const Place& place) const;

 private:
  void add(const Alignment& same);
  const std::vector<Place>& partners(const Place& place) const;

  const std::vector<Way>& ways_;
  std::vector<std::vector<std::vector<Place>>> partners_;  // by way and state
};

}  // namespace milepost
