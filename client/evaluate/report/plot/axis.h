// The axis of a plot: a range of values with round ticks.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace milepost::plot {

struct Ticks {
  double step = 0;             // 1, 2 or 5 times a power of ten
  int decimals = 0;            // that tell the ticks apart
  std::vector<double> values;  // multiples of step inside the range, ascending
};

// At most about `most` ticks. REQUIRES: from < to, both finite; most > 0.
Ticks round_ticks(double from, double to, int most);

class Axis {
 public:
  // From `from` to `to` as they are. Ends that are not finite or that leave no length between them
  // are replaced by some that do, so that an axis can always be drawn.
  static Axis spanning(std::string label, double from, double to, int most_ticks = 7);
  // With the ends moved outwards to the next ticks.
  static Axis rounded(std::string label, double from, double to, int most_ticks = 6);
  // By the logarithm, with ticks at the powers of ten. Ends that are not above 0, or leave no
  // length between them, are replaced by some that do.
  static Axis logarithmic(std::string label, double from, double to);

  const std::string& label() const { return label_; }  // with the unit: "error (m)"
  double from() const { return from_; }
  double to() const { return to_; }
  const Ticks& ticks() const { return ticks_; }
  std::string tick_text(double tick) const;
  // 0 at from, 1 at to; values outside the axis lie outside [0, 1]. Not finite where a logarithm
  // would not be.
  double share(double value) const;
  bool contains(double value) const { return from_ <= value && value <= to_; }

 private:
  enum class Scale { linear, logarithmic };

  Axis(std::string label, double from, double to, Ticks ticks, Scale scale = Scale::linear)
      : label_(std::move(label)), from_(from), to_(to), ticks_(std::move(ticks)), scale_(scale) {}

  std::string label_;
  double from_;
  double to_;
  Ticks ticks_;
  Scale scale_;
};

}  // namespace milepost::plot
