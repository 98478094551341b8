#include "tests/mapper/network/drawn_roads.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace milepost::testing {
namespace {

constexpr double kSpeedMps = 10;
constexpr double kLaneChangeM = 30;
constexpr double kUTurnRadiusM = 5;
constexpr double kCornerDeg = 40;  // places with sharper turns are corners
constexpr double kTurnRoundDeg = 170;

PlanPoint operator+(const PlanPoint& a, const PlanPoint& b) {
  return {a.east_m + b.east_m, a.north_m + b.north_m};
}
PlanPoint operator-(const PlanPoint& a, const PlanPoint& b) {
  return {a.east_m - b.east_m, a.north_m - b.north_m};
}
PlanPoint operator*(double k, const PlanPoint& a) { return {k * a.east_m, k * a.north_m}; }
double length(const PlanPoint& a) { return std::hypot(a.east_m, a.north_m); }
PlanPoint direction(const PlanPoint& from, const PlanPoint& to) {
  return 1 / length(to - from) * (to - from);
}
PlanPoint right_of(const PlanPoint& direction) { return {direction.north_m, -direction.east_m}; }
double heading_deg_of(const PlanPoint& direction) {
  return wrapped_360(std::atan2(direction.east_m, direction.north_m) / kRadPerDeg);
}
double turn_deg_at(const PlanPoint& from, const PlanPoint& at, const PlanPoint& to) {
  return turn_deg(heading_deg_of(at - from), heading_deg_of(to - at));
}

struct Waypoint {
  char place = 0;
  int lane = 1;  // from here on
};

// The middle of the n-th lane to the right.
double lane_offset_m(int lane) { return 1.75 + 3.5 * (lane - 1); }

std::vector<Waypoint> waypoints_of(const std::string& way) {
  std::vector<Waypoint> waypoints;
  std::istringstream words(way);
  int lane = 1;
  for (std::string word; words >> word;) {
    if (word.size() > 2) lane = std::stoi(word.substr(2));
    waypoints.push_back({word.front(), lane});
  }
  return waypoints;
}

// Out to a radius of 5 m, half a circle round the place to the left, and back to the lane.
void add_u_turn(const PlanPoint& place, const PlanPoint& ahead, double offset_m,
                double offset_back_m, std::vector<PlanPoint>& corners) {
  const PlanPoint right = right_of(ahead);
  corners.push_back(place + -20 * ahead + offset_m * right);
  for (int angle_deg = 0; angle_deg <= 180; angle_deg += 10) {
    const double angle_rad = angle_deg * kRadPerDeg;
    corners.push_back(place + kUTurnRadiusM * std::cos(angle_rad) * right +
                      kUTurnRadiusM * std::sin(angle_rad) * ahead);
  }
  corners.push_back(place + -20 * ahead + -offset_back_m * right);
}

// The corner at `place` of the lanes that come from `before` and go to `after`.
void add_corner(const PlanPoint& before, const PlanPoint& place, const PlanPoint& after,
                double offset_m, double next_offset_m, std::vector<PlanPoint>& corners) {
  const PlanPoint in = direction(before, place);
  const PlanPoint out = direction(place, after);
  const double sine = in.east_m * out.north_m - in.north_m * out.east_m;
  const double turn = turn_deg_at(before, place, after);
  if (std::abs(turn) > kTurnRoundDeg) {
    add_u_turn(place, in, offset_m, next_offset_m, corners);
  } else if (std::abs(turn) < 8) {
    corners.push_back(place + offset_m * right_of(in));
    if (offset_m != next_offset_m) {
      corners.push_back(place + kLaneChangeM * out + next_offset_m * right_of(out));
    }
  } else {  // where the offset lines intersect
    const PlanPoint apart = next_offset_m * right_of(out) - offset_m * right_of(in);
    const double along = (apart.east_m * out.north_m - apart.north_m * out.east_m) / sine;
    corners.push_back(place + offset_m * right_of(in) + along * in);
  }
}

// Replaces corners by arcs that touch the edges.
std::vector<PlanPoint> rounded(const std::vector<PlanPoint>& corners, double radius_m) {
  std::vector<PlanPoint> curve = {corners.front()};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const PlanPoint in = direction(corners[i - 1], corners[i]);
    const double turn = turn_deg_at(corners[i - 1], corners[i], corners[i + 1]) * kRadPerDeg;
    const double shorter_m =
        std::min(length(corners[i] - corners[i - 1]), length(corners[i + 1] - corners[i]));
    const double half_tangent = std::tan(std::abs(turn) / 2);
    const double tangent_m = std::min(radius_m * half_tangent, 0.45 * shorter_m);
    if (tangent_m < 0.05) {
      curve.push_back(corners[i]);
      continue;
    }
    const double fitting_radius_m = tangent_m / half_tangent;
    const PlanPoint begin = corners[i] - tangent_m * in;
    const PlanPoint to_centre = (turn > 0 ? 1 : -1) * right_of(in);
    for (int step = 0; step <= 20; ++step) {
      const double angle = std::abs(turn) * step / 20;
      curve.push_back(begin + fitting_radius_m * std::sin(angle) * in +
                      fitting_radius_m * (1 - std::cos(angle)) * to_centre);
    }
  }
  curve.push_back(corners.back());
  return curve;
}

// An error that changes slowly along the way: a Gauss-Markov process.
class SlowError {
 public:
  SlowError(double sigma_m, double length_m, std::mt19937& random)
      : sigma_m_(sigma_m), length_m_(length_m), random_(random), value_m_(sigma_m * normal()) {}
  double advanced(double by_m) {
    const double kept = std::exp(-by_m / length_m_);
    value_m_ = kept * value_m_ + std::sqrt(1 - kept * kept) * sigma_m_ * normal();
    return value_m_;
  }

 private:
  double normal() { return std::normal_distribution<double>()(random_); }
  double sigma_m_, length_m_;
  std::mt19937& random_;
  double value_m_;
};

std::mt19937 random_for(const std::string& name, unsigned seed) {
  std::vector<unsigned> numbers(name.begin(), name.end());
  numbers.push_back(seed);
  std::seed_seq sequence(numbers.begin(), numbers.end());
  return std::mt19937(sequence);
}

const LocalFrame& drawing_frame() {
  static const LocalFrame frame({49.01, 8.42, 0});
  return frame;
}

// A road between two places ("wx") or a turn at one ("wxe"), which a drive passes.
using Element = std::string;
using Itinerary = std::vector<Element>;

// Where in the itineraries: drive, and index in its itinerary.
using Passes = std::vector<std::pair<std::size_t, std::size_t>>;

}  // namespace

DrawnRoads::DrawnRoads(const std::string& drawing, const DrawingScale& scale) : scale_(scale) {
  std::istringstream lines(drawing);
  double row = 0;
  for (std::string line; std::getline(lines, line); ++row) {
    for (std::size_t column = 0; column < line.size(); ++column) {
      if (std::isalpha(static_cast<unsigned char>(line[column])) == 0) continue;
      const bool is_new =
          places_
              .insert({line[column],
                       {scale.column_m * static_cast<double>(column), -scale.row_m * row}})
              .second;
      if (!is_new) throw std::invalid_argument("a place is drawn twice");
    }
  }
}

GeoPoint DrawnRoads::geo_of(const PlanPoint& point, double altitude_m) {
  GeoPoint geo = drawing_frame().geo_from_enu({point.east_m, point.north_m, 0});
  geo.altitude_m = altitude_m;
  return geo;
}

PlanPoint DrawnRoads::plan_of(const GeoPoint& point) {
  const EnuPoint enu = drawing_frame().enu_from_geo({point.latitude_deg, point.longitude_deg, 0});
  return {enu.east_m, enu.north_m};
}

std::vector<PlanPoint> DrawnRoads::driven_curve(const std::string& way) const {
  const std::vector<Waypoint> waypoints = waypoints_of(way);
  const auto place_of = [&](std::size_t i) { return place(waypoints[i].place); };
  const auto offset_of = [&](std::size_t i) { return lane_offset_m(waypoints[i].lane); };
  const std::size_t last = waypoints.size() - 1;
  const auto beside = [&](std::size_t i, std::size_t leg) {
    return place_of(i) + offset_of(leg) * right_of(direction(place_of(leg), place_of(leg + 1)));
  };
  std::vector<PlanPoint> corners = {beside(0, 0)};
  for (std::size_t i = 1; i < last; ++i) {
    add_corner(place_of(i - 1), place_of(i), place_of(i + 1), offset_of(i - 1), offset_of(i),
               corners);
  }
  corners.push_back(beside(last, last - 1));
  return rounded(corners, scale_.corner_radius_m);
}

Drive DrawnRoads::drive(const DrawnDrive& drawn, const PositionErrors& errors) const {
  const std::vector<PlanPoint> curve = driven_curve(drawn.way);
  std::mt19937 random = random_for(drawn.name, errors.seed);
  std::normal_distribution<double> normal;
  SlowError slow_east(errors.slow_m, errors.slow_length_m, random);
  SlowError slow_north(errors.slow_m, errors.slow_length_m, random);
  Drive drive;
  drive.name = drawn.name;
  double before_m = 0;  // length of the curve before edge i
  double along_m = 0;   // of the next frame
  for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
    const double edge_m = length(curve[i + 1] - curve[i]);
    for (; edge_m > 0 && along_m < before_m + edge_m; along_m += scale_.frame_spacing_m) {
      const PlanPoint ahead = direction(curve[i], curve[i + 1]);
      const double spacing_m = scale_.frame_spacing_m;
      const PlanPoint noise = {errors.white_m * normal(random) + slow_east.advanced(spacing_m),
                               errors.white_m * normal(random) + slow_north.advanced(spacing_m)};
      const PlanPoint point =
          curve[i] + (along_m - before_m) * ahead + errors.right_m * right_of(ahead) + noise;
      Frame frame;
      frame.filename = std::to_string(drive.frames.size()) + ".png";
      frame.timestamp_s = along_m / kSpeedMps;
      frame.position = geo_of(point, drawn.altitude_m);
      frame.heading_deg = wrapped_360(heading_deg_of(ahead) + errors.heading_deg * normal(random));
      drive.frames.push_back(frame);
    }
    before_m += edge_m;
  }
  return drive;
}

std::vector<TrueSegment> DrawnRoads::true_segments(const std::vector<DrawnDrive>& drives) const {
  std::set<char> corners;
  std::vector<std::vector<Waypoint>> waypoints;
  for (const DrawnDrive& drive : drives) {
    waypoints.push_back(waypoints_of(drive.way));
    const std::vector<Waypoint>& way = waypoints.back();
    for (std::size_t i = 1; i + 1 < way.size(); ++i) {
      const double turn =
          turn_deg_at(place(way[i - 1].place), place(way[i].place), place(way[i + 1].place));
      const bool turns = std::abs(turn) > kCornerDeg && std::abs(turn) < kTurnRoundDeg;
      if (turns) corners.insert(way[i].place);
    }
  }

  std::vector<Itinerary> itineraries;
  std::map<Element, Passes> passes;
  for (std::size_t drive = 0; drive < drives.size(); ++drive) {
    Itinerary itinerary;
    const std::vector<Waypoint>& way = waypoints[drive];
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
      const bool turns_round = i > 0 && way[i - 1].place == way[i + 1].place;
      if (turns_round || (i > 0 && corners.contains(way[i].place))) {
        itinerary.push_back({way[i - 1].place, way[i].place, way[i + 1].place});
      }
      itinerary.push_back({way[i].place, way[i + 1].place});
    }
    for (std::size_t i = 0; i < itinerary.size(); ++i) passes[itinerary[i]].push_back({drive, i});
    itineraries.push_back(std::move(itinerary));
  }

  const auto turns_round = [](const Element& element) {
    return element.size() == 3 && element[0] == element[2];
  };
  const auto next_of = [&](const std::pair<std::size_t, std::size_t>& pass) -> Element {
    const Itinerary& itinerary = itineraries[pass.first];
    return pass.second + 1 < itinerary.size() ? itinerary[pass.second + 1] : Element();
  };
  const auto continuation = [&](const Element& element) -> Element {
    const Passes& here = passes.at(element);
    const Element next = next_of(here.front());
    const bool all = std::ranges::all_of(here, [&](const auto& p) { return next_of(p) == next; });
    const bool joins = !next.empty() && all && next != element && !turns_round(element) &&
                       !turns_round(next) && passes.at(next).size() == here.size();
    return joins ? next : Element();
  };
  // How far from a place its turns begin and end.
  const auto turn_reach_m = [&](const Element& element) {
    return turns_round(element) ? 0 : scale_.corner_radius_m;
  };
  const auto begin_of = [&](const Element& element) {
    const PlanPoint from = place(element[0]);
    const PlanPoint to = place(element[1]);
    if (element.size() == 3) return to - turn_reach_m(element) * direction(from, to);
    return corners.contains(element[0]) ? from + scale_.corner_radius_m * direction(from, to)
                                        : from;
  };
  const auto end_of = [&](const Element& element) {
    const PlanPoint from = place(element[element.size() - 2]);
    const PlanPoint to = place(element[element.size() - 1]);
    if (element.size() == 3) return from + turn_reach_m(element) * direction(from, to);
    return corners.contains(element[1]) ? to - scale_.corner_radius_m * direction(from, to) : to;
  };

  std::set<Element> continued;
  for (const auto& entry : passes) continued.insert(continuation(entry.first));
  std::map<Element, std::size_t> index_of;  // of the segment that begins with it
  std::vector<Element> last_of;
  std::vector<TrueSegment> segments;
  for (const auto& [element, here] : passes) {
    if (continued.contains(element)) continue;
    Element last = element;
    while (!continuation(last).empty()) last = continuation(last);
    index_of[element] = segments.size();
    last_of.push_back(last);
    TrueSegment segment{{}, begin_of(element), end_of(last), {}};
    for (const auto& pass : here) segment.passes.push_back(drives[pass.first].name);
    std::ranges::sort(segment.passes);
    segments.push_back(std::move(segment));
  }
  for (std::size_t i = 0; i < segments.size(); ++i) {
    std::set<std::size_t> successors;
    for (const auto& pass : passes.at(last_of[i])) {
      const Element next = next_of(pass);
      if (!next.empty()) successors.insert(index_of.at(next));
    }
    segments[i].successors.assign(successors.begin(), successors.end());
  }
  return segments;
}

}  // namespace milepost::testing
