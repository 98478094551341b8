#include "mapper/findings/heading_findings.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "mapper/findings/trajectory_place.h"
#include "schema/base/digits.h"
#include "schema/base/median.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr std::size_t kFewestChords = 5;
constexpr double kMaxOffsetDeg = 5;
constexpr double kMaxNoiseDeg = 1.5;
constexpr double kFarDeg = 30;
constexpr double kMaxFarShare = 0.02;

// What could have been recorded instead of positions or headings.
struct Mistake {
  const char* kind;
  std::function<Eigen::Vector2d(const Eigen::Vector2d&)> way;  // as it was, from what was recorded
  const char* what;
  const char* hint;
};

constexpr const char* kExchanged =
    "the headings fit the way if its axes are exchanged: east for north, latitude for longitude, "
    "or headings that count from east, counterclockwise";
constexpr const char* kExchangedMend = "correct the columns; headings count clockwise from north";

// What may be wrong with a drive at `there`, as it was recorded.
std::vector<Mistake> mistakes_at(const GeoPoint& there) {
  using Way = Eigen::Vector2d;
  // A degree of longitude is shorter than one of latitude.
  const double recorded = std::cos(there.latitude_deg * kRadPerDeg);
  const double actual = std::cos(there.longitude_deg * kRadPerDeg);
  return {
      {"reversed_camera", [](const Way& way) -> Way { return -way; },
       "the headings point against the direction of travel: the camera looks back, or they were "
       "turned by 180 degrees",
       "correct them; of a camera that looks back, a camera that looks ahead finds nothing"},
      {"exchanged_axes",
       [](const Way& way) -> Way {
         return {way.y(), way.x()};
       },
       kExchanged, kExchangedMend},
      {"exchanged_axes",
       [=](const Way& way) -> Way {
         return {way.y() * actual, way.x() / recorded};
       },
       kExchanged, kExchangedMend},
      {"mirrored_axis",
       [](const Way& way) -> Way {
         return {-way.x(), way.y()};
       },
       "the headings fit the way if east and west are exchanged: a sign, or headings that count "
       "counterclockwise from north",
       "correct the sign; headings count clockwise from north"},
      {"mirrored_axis",
       [](const Way& way) -> Way {
         return {way.x(), -way.y()};
       },
       "the headings fit the way if north and south are exchanged",
       "correct the sign of the northing or of the headings"}};
}

// How far the headings are turned from the ways, how much that varies, and on what share of them
// it is far.
struct Turned {
  double median_deg = 0;
  double sigma_deg = 0;
  double far_share = 0;

  bool fits(double noise_deg) const {
    return std::abs(median_deg) <= kMaxOffsetDeg && sigma_deg <= kMaxOffsetDeg + noise_deg &&
           far_share <= kMaxFarShare;
  }
};

// A part of the way over which noise of positions hardly turns it.
struct Chord {
  std::size_t from = 0;
  std::size_t to = 0;
  Eigen::Vector2d way_m;  // east, north
};

std::vector<Chord> chords_of(const Drive& drive, const std::vector<Step>& steps) {
  constexpr double kLengthM = 5;
  constexpr double kPauseS = 10;
  std::vector<Chord> chords;
  for (std::size_t from = 0; from < steps.size(); ++from) {
    Eigen::Vector2d way_m = Eigen::Vector2d::Zero();
    for (std::size_t i = from; i < steps.size(); ++i) {
      way_m += steps[i].way_m.head<2>();
      if (steps[i].elapsed_s > kPauseS) break;
      if (way_m.norm() < kLengthM) continue;
      // A turn that the chord cuts short is told by neither.
      if (std::abs(turn_deg(drive.frames[from].heading_deg, drive.frames[i + 1].heading_deg)) < 60)
        chords.push_back({from, i + 1, way_m});
      break;
    }
  }
  return chords;
}

class HeadingCheck {
 public:
  HeadingCheck(const Drive& drive, const std::vector<Step>& steps)
      : drive_(drive), chords_(chords_of(drive, steps)) {}

  std::vector<Finding> run() const {
    std::vector<Finding> findings;
    if (chords_.size() < kFewestChords) return findings;
    const double noise_deg = this->noise_deg();
    const Turned turned = turned_from([](const Eigen::Vector2d& way) { return way; }, 1);
    if (!turned.fits(noise_deg)) findings.push_back(cause_of(turned, noise_deg));
    if (noise_deg > kMaxNoiseDeg) {
      findings.push_back(on_trajectory(
          drive_, "heading_noise", drive_.frames.front(), drive_.frames.size(),
          "the headings vary by " + fixed(noise_deg, 1) + " degrees from frame to frame",
          "record the camera's headings, or smooth them; the images mend what they can"));
    }
    return findings;
  }

 private:
  // Of the middle of a chord.
  double heading_deg(const Chord& chord, double unit) const {
    const double from_deg = unit * recorded_pose(drive_, drive_.frames[chord.from]).heading_deg;
    const double to_deg = unit * recorded_pose(drive_, drive_.frames[chord.to]).heading_deg;
    return from_deg + turn_deg(from_deg, to_deg) / 2;
  }

  template <class Way>
  Turned turned_from(const Way& way_of, double unit) const {
    std::vector<double> turned_deg;
    for (const Chord& chord : chords_) {
      const Eigen::Vector2d way = way_of(chord.way_m);
      const double course_deg = std::atan2(way.x(), way.y()) * kDegPerRad;
      turned_deg.push_back(turn_deg(course_deg, heading_deg(chord, unit)));
    }
    const auto far =
        std::ranges::count_if(turned_deg, [](double turned) { return std::abs(turned) > kFarDeg; });
    const double far_share = static_cast<double>(far) / static_cast<double>(turned_deg.size());
    // About the first, so that a median is not cut in two where angles wrap around.
    const double first_deg = turned_deg.front();
    for (double& each : turned_deg) each = turn_deg(first_deg, each);
    return {turn_deg(0, first_deg + median_of(turned_deg)), robust_sigma_of(turned_deg), far_share};
  }

  Finding cause_of(const Turned& turned, double noise_deg) const {
    const Frame& first = drive_.frames.front();
    const std::size_t count = drive_.frames.size();
    for (const Mistake& mistake : mistakes_at(first.position)) {
      if (turned_from(mistake.way, 1).fits(noise_deg))
        return on_trajectory(drive_, mistake.kind, first, count, mistake.what, mistake.hint);
    }
    const auto as_it_is = [](const Eigen::Vector2d& way) { return way; };
    const bool is_small = std::ranges::all_of(
        drive_.frames, [](const Frame& frame) { return frame.heading_deg < 6.3; });
    if (is_small && turned_from(as_it_is, kDegPerRad).fits(noise_deg)) {
      return on_trajectory(drive_, "heading_in_radians", first, count,
                           "the headings fit the way as radians", "give them in degrees");
    }
    return on_trajectory(drive_, "heading_offset", first, count,
                         "the headings are turned by " + fixed(turned.median_deg, 1) +
                             " degrees from the direction of travel, give or take " +
                             fixed(turned.sigma_deg, 1),
                         "correct them, or give the camera's yaw as mounting.yaw_deg");
  }

  double noise_deg() const {
    std::vector<double> off_deg;
    for (std::size_t i = 1; i + 1 < drive_.frames.size(); ++i) {
      const Frame& before = drive_.frames[i - 1];
      const Frame& at = drive_.frames[i];
      const Frame& after = drive_.frames[i + 1];
      const double part =
          (at.timestamp_s - before.timestamp_s) / (after.timestamp_s - before.timestamp_s);
      off_deg.push_back(turn_deg(before.heading_deg, at.heading_deg) -
                        part * (turn_deg(before.heading_deg, at.heading_deg) +
                                turn_deg(at.heading_deg, after.heading_deg)));
    }
    return noise_of(off_deg);
  }

  const Drive& drive_;
  std::vector<Chord> chords_;
};

// A vehicle on a road is level from side to side.
std::optional<Finding> tilted(const Drive& drive) {
  constexpr double kLargestDeg = 5;
  std::vector<double> rolls_deg;
  rolls_deg.reserve(drive.frames.size());
  for (const Frame& frame : drive.frames) rolls_deg.push_back(recorded_pose(drive, frame).roll_deg);
  const double roll_deg = median_of(rolls_deg);
  if (std::abs(roll_deg) <= kLargestDeg) return std::nullopt;
  return on_trajectory(drive, "tilted", drive.frames.front(), drive.frames.size(),
                       "everything is rolled by " + fixed(roll_deg, 1) + " degrees in the median",
                       "give the camera's roll as mounting.roll_deg; a model that was aligned by "
                       "positions on a straight line is rolled by chance: align it otherwise");
}

}  // namespace

std::vector<Finding> heading_findings(const Drive& drive, const std::vector<Step>& steps) {
  std::vector<Finding> findings = HeadingCheck(drive, steps).run();
  if (auto found = tilted(drive)) findings.push_back(std::move(*found));
  return findings;
}

}  // namespace milepost
