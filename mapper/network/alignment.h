// Aligns parts of two ways that run beside each other in one direction.
#pragma once

#include <cstddef>
#include <vector>

#include "mapper/network/way.h"

namespace milepost {

// Two states of two ways on one cross-section of the road: the offset between them is perpendicular
// to the mean of their directions.
struct Match {
  double along_b_m = 0;  // of b's state; a's is known from the match's index
  double apart_m = 0;    // infinite where none was found, between others
  double turn_deg = 0;   // between the directions, [0, 180]
  double climb_m = 0;    // difference of altitudes, >= 0; 0 if either way has none
};

// A monotone path through the free space of two curves (Alt and Godau, 1995), partial as in Buchin,
// Buchin and Wang (2009), kept to cross-sections. That a and b share a cross-section is symmetric,
// so it does not matter which is called a.
struct Alignment {
  std::size_t a = 0, b = 0;    // indices of ways, a <= b; if equal, b's part comes later
  std::size_t first = 0;       // a's state of the first match
  std::vector<Match> matches;  // one for each state of a from `first`; along_b_m does not decrease
};

struct AlignmentSettings {
  double reach_m = 8;         // states farther apart are not compared
  double max_turn_deg = 60;   // nor are those with directions farther apart
  double max_missing_m = 15;  // the path is carried on over such a stretch without matches
  double max_slip_m = 5;      // by which the two may advance differently from match to match
  double min_lap_m = 20;      // a way is not compared to itself nearer than this along it
};

// All alignments, ordered by a, then by where they end.
std::vector<Alignment> alignments(const std::vector<Way>& ways, const AlignmentSettings& settings);

}  // namespace milepost
