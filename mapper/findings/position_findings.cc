#include "mapper/findings/position_findings.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mapper/findings/rounded_positions.h"
#include "mapper/findings/trajectory_place.h"
#include "mapper/geodata/between.h"
#include "schema/base/digits.h"
#include "schema/base/median.h"

namespace milepost {
namespace {

// Rows that show one thing.
struct Rows {
  const Frame* first = nullptr;
  std::size_t count = 0;

  void add(const Frame& frame) {
    if (count++ == 0) first = &frame;
  }
};

class PositionCheck {
 public:
  PositionCheck(const Drive& drive, const std::vector<Step>& steps)
      : drive_(drive), steps_(steps) {}

  std::vector<Finding> run() {
    null_island();
    rounded();
    repeated();
    noise();
    sparse();
    standstill();
    receiver_apart();
    return std::move(findings_);
  }

 private:
  const Frame& frame(std::size_t i) const { return drive_.frames[i]; }

  void tell(const std::string& kind, const Rows& rows, const std::string& what,
            const std::string& hint) {
    if (rows.count == 0) return;
    findings_.push_back(on_trajectory(drive_, kind, *rows.first, rows.count, what, hint));
  }

  Rows all() const { return {&drive_.frames.front(), drive_.frames.size()}; }

  void null_island() {
    constexpr double kAboutDeg = 0.01;
    Rows rows;
    for (const Frame& at : drive_.frames) {
      if (std::abs(at.position.latitude_deg) < kAboutDeg &&
          std::abs(at.position.longitude_deg) < kAboutDeg)
        rows.add(at);
    }
    tell("null_island", rows, "positions at latitude 0, longitude 0",
         "leave out rows without a position");
  }

  void rounded() {
    rounding_m_ = rounding_step_m(drive_);
    if (rounding_m_ == 0) return;
    tell("rounded_positions", all(),
         "the positions are rounded to " + fixed(rounding_m_, 2) +
             " m, which the map's position error counts",
         "export them with more digits");
  }

  // A table of positions that come less often than frames, repeated until the next one.
  void repeated() {
    constexpr double kSameM = 0.001;
    constexpr double kStandingS = 5;
    Rows rows;
    for (std::size_t i = 0; i + 1 < steps_.size(); ++i) {
      const bool stands = steps_[i].way_m.norm() < kSameM;
      const bool moves_on = steps_[i + 1].length_m() >= kLeastStepM;
      if (stands && moves_on && steps_[i].elapsed_s < kStandingS) rows.add(frame(i + 1));
    }
    if (rows.count < 3) return;
    has_repeated_ = true;
    tell("repeated_positions", rows,
         "frames of the moving vehicle have the position of the frame before",
         "give each frame the position at its own time");
  }

  // Sideways and upwards, where vehicles do not jump.
  void noise() {
    constexpr double kMaxSidewaysM = 0.06;
    constexpr double kMaxUpM = 0.06;
    std::vector<double> sideways_m;
    std::vector<double> up_m;
    for (std::size_t i = 1; i < steps_.size(); ++i) {
      const Step& before = steps_[i - 1];
      const Step& after = steps_[i];
      if (before.length_m() < kLeastStepM || after.length_m() < kLeastStepM) continue;
      const double part = before.elapsed_s / (before.elapsed_s + after.elapsed_s);
      const Eigen::Vector3d chord = before.way_m + after.way_m;
      const Eigen::Vector3d off = before.way_m - part * chord;
      const Eigen::Vector2d ahead = chord.head<2>().normalized();
      sideways_m.push_back(off.x() * ahead.y() - off.y() * ahead.x());
      up_m.push_back(off.z());
    }
    const double sideways_sigma_m = noise_of(sideways_m);
    if (sideways_sigma_m > kMaxSidewaysM && rounding_m_ == 0 && !has_repeated_) {
      tell(
          "position_noise", all(),
          "the positions vary by " + fixed(sideways_sigma_m, 2) + " m sideways from frame to frame",
          "record them with a better receiver, or smooth them with the inertial data");
    }
    const double up_sigma_m = noise_of(up_m);
    if (up_sigma_m > kMaxUpM) {
      tell("altitude_noise", all(),
           "the altitudes vary by " + fixed(up_sigma_m, 2) + " m from frame to frame",
           "smooth them; the images mend what they can");
      return;
    }
    altitude_jumps();
  }

  void altitude_jumps() {
    constexpr double kSteepest = 0.35;
    constexpr double kMarginM = 0.5;
    Rows rows;
    double greatest_m = 0;
    for (const Step& step : steps_) {
      const double rise_m = std::abs(step.way_m.z());
      if (rise_m <= kSteepest * step.length_m() + kMarginM) continue;
      rows.add(frame(step.from + 1));
      greatest_m = std::max(greatest_m, rise_m);
    }
    tell("altitude_jump", rows,
         "the altitude jumps by up to " + fixed(greatest_m, 1) + " m between frames",
         "correct the altitudes; do they all count from the ellipsoid?");
  }

  void sparse() {
    constexpr double kMaxSpacingM = 5.5;
    std::vector<double> spacings_m;
    for (const Step& step : steps_)
      if (step.length_m() >= kLeastStepM) spacings_m.push_back(step.length_m());
    if (spacings_m.empty()) return;
    const double median_m = median_of(spacings_m);
    if (median_m <= kMaxSpacingM) return;
    tell("sparse_frames", all(),
         "frames lie " + fixed(median_m, 1) + " m apart (median): few features are seen in three",
         "record a frame each 1 to 3 m");
  }

  void standstill() {
    constexpr double kAboutM = 2;
    constexpr double kLongS = 10;
    constexpr double kDriftM = 0.4;
    Rows rows;
    double greatest_m = 0;
    for (std::size_t from = 0; from + 1 < drive_.frames.size();) {
      std::size_t to = from;
      double extent_m = 0;
      while (to + 1 < drive_.frames.size()) {
        const double away_m = geodesic_distance_m(frame(from).position, frame(to + 1).position);
        if (away_m > kAboutM) break;
        extent_m = std::max(extent_m, away_m);
        ++to;
      }
      const double lasted_s = frame(to).timestamp_s - frame(from).timestamp_s;
      if (to > from + 3 && lasted_s > kLongS && extent_m > kDriftM && wanders(from, to)) {
        for (std::size_t i = from; i <= to; ++i) rows.add(frame(i));
        greatest_m = std::max(greatest_m, extent_m);
      }
      from = std::max(to, from + 1);
    }
    tell("standstill", rows,
         "the positions of the standing vehicle wander by " + fixed(greatest_m, 1) +
             " m, which adds no road",
         "hold them while it stands");
  }

  // Whether the way between two frames is much longer than it leads away.
  bool wanders(std::size_t from, std::size_t to) const {
    double way_m = 0;
    for (std::size_t i = from; i < to; ++i) way_m += steps_[i].length_m();
    return way_m > 2 * geodesic_distance_m(frame(from).position, frame(to).position);
  }

  // The trajectory's position at a time, if it has one then.
  std::optional<GeoPoint> position_at(double timestamp_s) const {
    const auto after =
        std::ranges::lower_bound(drive_.frames, timestamp_s, {}, &Frame::timestamp_s);
    if (after == drive_.frames.end() || after == drive_.frames.begin()) return std::nullopt;
    const Frame& to = *after;
    const Frame& from = *(after - 1);
    const double part = (timestamp_s - from.timestamp_s) / (to.timestamp_s - from.timestamp_s);
    return position_between(from.position, to.position, part);
  }

  void receiver_apart() {
    constexpr double kSigmas = 4;
    constexpr double kMarginM = 15;
    constexpr std::size_t kFewest = 3;
    std::vector<double> apart_m;
    std::vector<double> allowed_m;
    for (const GpsFix& fix : drive_.gps) {
      const auto recorded = position_at(fix.timestamp_s);
      if (!recorded) continue;
      apart_m.push_back(geodesic_distance_m(*recorded, fix.position));
      allowed_m.push_back(kSigmas * fix.sigma_m + kMarginM);
    }
    if (apart_m.size() < kFewest) return;
    const double median_m = median_of(apart_m);
    if (median_m <= median_of(allowed_m)) return;
    tell("receiver_apart", all(),
         "gps.csv lies " + fixed(median_m, 0) + " m from the trajectory (median)",
         "check columns, signs and clocks of both tables");
  }

  const Drive& drive_;
  const std::vector<Step>& steps_;
  double rounding_m_ = 0;
  bool has_repeated_ = false;
  std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> position_findings(const Drive& drive, const std::vector<Step>& steps) {
  return PositionCheck(drive, steps).run();
}

}  // namespace milepost
