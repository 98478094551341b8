// A small language for tests: a drawing of roads, and drives as lists of its places.
//
//         n          A letter is a place; a column is 4 m wide, a row 8 m high. Other characters
//         |          are there for the eye. A drive "w x n" goes from w by x to n, on the right of
//     w---x---e      the lines between them: in lane 1, or in another from a place on ("w x:2 n").
//         |          It rounds corners, changes lanes over 30 m, and turns round at a place where
//         it s          goes back ("s x s").
#pragma once

#include <map>
#include <string>
#include <vector>

#include "mapper/network/road_network.h"
#include "schema/drive/drive.h"

namespace milepost::testing {

// Metres east and north of the drawing's lower left corner.
struct PlanPoint {
  double east_m = 0;
  double north_m = 0;
};

struct DrawnDrive {
  std::string name;
  std::string way;  // "w x:2 n"
  double altitude_m = 0;
};

// Errors of recorded positions: standard deviations, and how far along the way the slow ones are
// correlated.
struct PositionErrors {
  double white_m = 0;
  double slow_m = 0;
  double slow_length_m = 200;
  double right_m = 0;  // the same everywhere
  double heading_deg = 0;
  unsigned seed = 1;
};

struct DrawingScale {
  double column_m = 4;
  double row_m = 8;
  double corner_radius_m = 8;
  double frame_spacing_m = 1.97;  // not a divisor of the grid of cuts
};

// A segment as drawn: its drives, its ends, and which segments follow.
struct TrueSegment {
  std::vector<std::string> passes;  // names of drives, sorted; repeated for repeated passes
  PlanPoint begin, end;
  std::vector<std::size_t> successors;  // indices, sorted
};

class DrawnRoads {
 public:
  explicit DrawnRoads(const std::string& drawing, const DrawingScale& scale = {});

  PlanPoint place(char letter) const { return places_.at(letter); }

  // The drive as recorded, 10 m a second.
  Drive drive(const DrawnDrive& drawn, const PositionErrors& errors = {}) const;

  // The network that the drives' places alone say: maximal sequences of roads between two places,
  // and of turns at a place, with the same passes. Turns count at places where drives turn by more
  // than 40 degrees: they are roads of 10 m and more.
  std::vector<TrueSegment> true_segments(const std::vector<DrawnDrive>& drives) const;

  static GeoPoint geo_of(const PlanPoint& point, double altitude_m);
  static PlanPoint plan_of(const GeoPoint& point);

 private:
  std::vector<PlanPoint> driven_curve(const std::string& way) const;

  DrawingScale scale_;
  std::map<char, PlanPoint> places_;
};

}  // namespace milepost::testing
