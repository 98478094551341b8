// The variances of what drives' slow errors are made of, from squares that an estimate expects: of
// each drive, drawn to what all drives have in common (the distribution of all errors has long
// tails).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "mapper/fusion/pose_error.h"

namespace milepost {

// Axes that share their variances: those of the position, and roll.
struct AxisKind {
  int first = 0;
  int axes = 0;
};
inline constexpr std::array<AxisKind, 2> kAxisKinds = {{{0, kRollAxis}, {kRollAxis, 1}}};
using ByKind = Eigen::Vector2d;

// The diagonal of a matrix of all axes.
ErrorVector on_axes(const ByKind& of_kind);

// Sums of squares, and of how many values.
struct Squares {
  ByKind sums = ByKind::Zero();
  ByKind counts = ByKind::Zero();
  bool is_stated = false;  // of positions, in units of what was stated
};

// The medians of the drives' mean squares, at least `least`; of positions that are stated nothing
// is told, and where none is left the variance is `usual_m2`. REQUIRES: not empty.
ByKind common_variances(const std::vector<Squares>& squares, double usual_m2, const ByKind& least);

// What is common counts as `prior` values. What is stated, `stated_m2`, counts as common and as the
// least.
ByKind drawn_variances(const Squares& own, ByKind common, double prior, double stated_m2);

// What the variance of few values is multiplied by so that two sigma of a normal distribution hold
// what two sigma of Student's t hold. REQUIRES: `values` is not zero.
double few_values_factor(std::size_t values);

}  // namespace milepost
