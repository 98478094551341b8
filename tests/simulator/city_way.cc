#include "tests/simulator/city_way.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <utility>

namespace milepost::simulator {
namespace {

constexpr double kLaneChangeM = 40;
constexpr double kBeforeLaneChangeM = 22;

// Into a ring, counter-clockwise, and out again.
std::vector<Path> around_ring(const Junction& ring, const Directed& from, const Directed& to,
                              int extra_rounds) {
  const double reach_rad = ring.ring_radius_m > 10 ? 0.49 : 1.0;  // of the way in and of that out
  const auto angle_of = [&](const cv::Vec2d& at) {
    return std::atan2(at[1] - ring.at[1], at[0] - ring.at[0]);
  };
  const double in = angle_of(from.at) + reach_rad;
  const double out = angle_of(to.at) - reach_rad;
  constexpr double kRound = 2 * std::numbers::pi;
  const double turn = out - in - std::floor((out - in) / kRound) * kRound + extra_rounds * kRound;
  const auto on_ring = [&](double angle) {
    return Directed{ring.at + cv::Vec2d(std::cos(angle), std::sin(angle)) * ring.ring_radius_m,
                    -angle};
  };
  const Directed entry = on_ring(in);
  const Directed leaving = on_ring(in + turn);
  return {Path::joining(from, entry),
          Path::arc(entry, turn * ring.ring_radius_m, -1 / ring.ring_radius_m),
          Path::joining(leaving, to)};
}

class Way {
 public:
  explicit Way(const City& city) : city_(city) {}

  void pass(const Pass& pass) {
    const Edge& edge = city_.edges[pass.edge];
    if (pass.lane_between == 0 || pass.lane_between == pass.lane) {
      follow(edge, pass.lane, 0, edge.middle.length_m());
      return;
    }
    const double first_m = kBeforeLaneChangeM;
    const double last_m = edge.middle.length_m() - kBeforeLaneChangeM;
    follow(edge, pass.lane, 0, first_m);
    change(edge, first_m, pass.lane, pass.lane_between);
    follow(edge, pass.lane_between, first_m + kLaneChangeM, last_m - kLaneChangeM);
    change(edge, last_m - kLaneChangeM, pass.lane_between, pass.lane);
    follow(edge, pass.lane, last_m, edge.middle.length_m());
  }

  void cross(const Pass& before, const Pass& after) {
    const Edge& in = city_.edges[before.edge];
    const Junction& junction = city_.junctions[in.to];
    const Directed from = parts_.back().end();
    const Directed to =
        lane_of(city_.edges[after.edge], after.lane, 0, city_.edges[after.edge].middle.length_m())
            .start();
    begin_span({0, junction.name, 0, false, false});
    if (junction.ring_radius_m == 0) {
      add(Path::joining(from, to));
      return;
    }
    for (const Path& part : around_ring(junction, from, to, before.extra_rounds)) add(part);
  }

  Route finish(const std::string& name) {
    return {name, Path::chain(parts_), 0, std::move(spans_)};
  }

 private:
  static Path lane_of(const Edge& edge, int lane, double from_m, double to_m) {
    return edge.middle.part(from_m, to_m).shifted(edge.lane_offset_m(lane));
  }

  void add(const Path& part) {
    length_m_ += part.length_m();
    parts_.push_back(part);
  }

  void begin_span(RouteSpan span) {
    span.from_m = length_m_;
    spans_.push_back(std::move(span));
  }

  void begin_lane(const Edge& edge, int lane) {
    const bool has_oncoming = edge.has_oncoming && lane == 1;
    begin_span({0, edge.name, lane, has_oncoming, edge.is_on_bridge});
  }

  void follow(const Edge& edge, int lane, double from_m, double to_m) {
    begin_lane(edge, lane);
    add(lane_of(edge, lane, from_m, to_m));
  }

  // Half of the way counts for each of the two lanes.
  void change(const Edge& edge, double from_m, int lane, int to_lane) {
    const Path before = lane_of(edge, lane, from_m, from_m + kLaneChangeM);
    const Path after = lane_of(edge, to_lane, from_m, from_m + kLaneChangeM);
    const Path over = Path::joining(before.start(), after.end());
    begin_lane(edge, lane);
    spans_.back().has_oncoming = false;
    add(over.part(0, over.length_m() / 2));
    begin_lane(edge, to_lane);
    spans_.back().has_oncoming = false;
    add(over.part(over.length_m() / 2, over.length_m()));
  }

  const City& city_;
  std::vector<Path> parts_;
  std::vector<RouteSpan> spans_;
  double length_m_ = 0;
};

}  // namespace

std::vector<Pass> passes_through(const City& city, const std::string& turns) {
  std::vector<Pass> passes;
  std::istringstream words(turns);
  std::string word;
  words >> word;
  std::size_t at = city.junction(word);
  std::string by;  // the name of the edge, if given
  while (words >> word) {
    if (word.find('.') != std::string::npos) {
      by = word;
      continue;
    }
    const std::size_t star = word.find('*');
    const int extra_rounds = star == std::string::npos ? 0 : std::stoi(word.substr(0, star));
    const std::size_t next =
        city.junction(star == std::string::npos ? word : word.substr(star + 1));
    const auto edge = std::find_if(city.edges.begin(), city.edges.end(), [&](const Edge& each) {
      return each.from == at && each.to == next && (by.empty() || each.name == by);
    });
    passes.push_back({static_cast<std::size_t>(edge - city.edges.begin()), 1, 0, extra_rounds});
    at = next;
    by.clear();
  }
  return passes;
}

bool has_room_for_lane_changes(const Edge& edge) {
  constexpr double kLeastBetweenM = 25;
  const double length_m = edge.middle.length_m();
  const double change_m = kBeforeLaneChangeM + kLaneChangeM;
  if (length_m < 2 * change_m + kLeastBetweenM) return false;
  for (double along = kBeforeLaneChangeM; along < change_m; along += 1) {
    if (edge.middle.curvature_per_m_at(along) != 0) return false;
    if (edge.middle.curvature_per_m_at(length_m - along) != 0) return false;
  }
  return true;
}

Route route_of(const City& city, const CityDrive& drive) {
  Way way(city);
  for (std::size_t i = 0; i < drive.passes.size(); ++i) {
    if (i > 0) way.cross(drive.passes[i - 1], drive.passes[i]);
    way.pass(drive.passes[i]);
  }
  return way.finish(drive.name);
}

}  // namespace milepost::simulator
