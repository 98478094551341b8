#include "tests/simulator/city_roads.h"

#include "tests/simulator/city_builder.h"
#include "tests/simulator/paint.h"

namespace milepost::simulator {
namespace {

constexpr double kParkingM = 2.1;
constexpr double kRingRadiusM = 16;
constexpr double kRingHalfWidthM = 4.2;
constexpr double kTurningRadiusM = 7;
constexpr double kTurningHalfWidthM = 3.4;
constexpr double kRingClearM = 12;     // from a ring's middle to the end of an edge
constexpr double kPartingM = 16;       // half the length over which two lanes part or join
constexpr double kQuayGapM = 8;        // between the middles of the parallel one-way streets
constexpr double kMedianM = 4;         // of the dual carriageway
constexpr double kCarriagewayM = 3.4;  // half its width

// Everything of the full city that the seed decides.
struct Plan {
  double west_cross_n, north_gate_n, mill_e, ramp_e, east_e, hill_e, hill_n, loop_w, loop_n;
  double north_road_w, quay_n, split_e, join_e, foot_e, bend_n, mill_end_n, exit_e;
  double hill_height_m, swell_phase;
};

Plan plan_of(std::uint64_t seed) {
  cv::RNG random = seeded(seed * 7 + 3);
  const auto near = [&random](double value, double spread) {
    return value + random.uniform(-spread, spread);
  };
  Plan plan;
  plan.west_cross_n = near(202, 4);
  plan.north_gate_n = near(302, 5);
  plan.mill_e = near(216, 8);
  plan.ramp_e = near(336, 5);
  plan.east_e = near(436, 6);
  plan.hill_e = near(524, 6);
  plan.hill_n = near(252, 10);
  plan.loop_w = near(-122, 5);
  plan.loop_n = near(158, 3);
  plan.north_road_w = near(-108, 6);
  plan.quay_n = near(0, 4);
  plan.split_e = near(44, 4);
  plan.join_e = near(262, 6);
  plan.foot_e = near(330, 6);
  plan.bend_n = plan.quay_n + near(46, 2);
  plan.mill_end_n = near(258, 3);
  plan.exit_e = near(226, 6);
  plan.hill_height_m = near(9, 2);
  plan.swell_phase = near(0, 3);
  return plan;
}

// The full city. Its parts are in the order in which one meets them from west to east.
class FullCity {
 public:
  explicit FullCity(std::uint64_t seed) : plan_(plan_of(seed)), builder_(seed) {}

  City build() {
    Terrain& terrain = builder_.terrain();
    terrain.hill_top = {plan_.hill_e - 10, plan_.hill_n};
    terrain.hill_height_m = plan_.hill_height_m;
    terrain.hill_reach_m = 60;
    terrain.swell_phase = plan_.swell_phase;
    add_junctions();
    add_west();
    add_avenue();
    add_middle();
    add_quay();
    add_east();
    builder_.add_ring(ring_, kRingHalfWidthM, Frontage::avenue);
    builder_.add_ring(mill_end_, kTurningHalfWidthM, Frontage::narrow);
    return builder_.finish({-200, -60}, {592, 388});
  }

 private:
  static RoadStop at(std::size_t junction, double along_m, double clear_m = 12) {
    return {junction, along_m, clear_m, clear_m};
  }

  void add_junctions() {
    const auto add = [&](const char* name, JunctionKind kind, double east, double north,
                         double ring_radius_m = 0) {
      return builder_.add_junction(name, kind, {east, north}, ring_radius_m);
    };
    north_gate_ = add("north-gate", JunctionKind::tee, 0, plan_.north_gate_n);
    west_cross_ = add("west-cross", JunctionKind::crossing, 0, plan_.west_cross_n);
    market_cross_ = add("market-cross", JunctionKind::crossing, 0, kMarketNorthM);
    garden_ = add("garden", JunctionKind::tee, kGardenEastM, kMarketNorthM);
    exit_ = add("exit", JunctionKind::exit, plan_.exit_e, eastbound_n() - kLaneM);
    ring_ = add("ring", JunctionKind::roundabout, plan_.east_e, plan_.north_gate_n, kRingRadiusM);
    mill_cross_ = add("mill-cross", JunctionKind::crossing, plan_.mill_e, plan_.west_cross_n);
    mill_end_ =
        add("mill-end", JunctionKind::dead_end, plan_.mill_e, plan_.mill_end_n, kTurningRadiusM);
    ramp_end_ = add("ramp-end", JunctionKind::tee, plan_.ramp_e, plan_.west_cross_n);
    east_cross_ = add("east-cross", JunctionKind::crossing, plan_.east_e, plan_.west_cross_n);
    east_gate_ = add("east-gate", JunctionKind::tee, plan_.east_e, kMarketNorthM);
    quay_split_ = add("quay-split", JunctionKind::split, plan_.split_e, plan_.quay_n);
    quay_join_ = add("quay-join", JunctionKind::join, plan_.join_e, plan_.quay_n);
    bridge_foot_ = add("bridge-foot", JunctionKind::tee, plan_.foot_e, plan_.quay_n);
  }

  void add_west() {
    const double market_to_west = plan_.west_cross_n - kMarketNorthM;
    const double length = plan_.north_gate_n - kMarketNorthM;
    builder_.add_road(
        {"west-street",
         Path::through({{{0, kMarketNorthM}}, {{0, plan_.north_gate_n}}}),
         Ways::both,
         1,
         {{0, Frontage::canyon}},
         kParkingM,
         {at(market_cross_, 0), at(west_cross_, market_to_west, 13), at(north_gate_, length, 13)}});
    const Path north_road = Path::through({{{0, plan_.north_gate_n}},
                                           {{plan_.north_road_w, plan_.north_gate_n}, 28},
                                           {{plan_.north_road_w, plan_.west_cross_n}, 22},
                                           {{0, plan_.west_cross_n}}});
    builder_.add_road({"north-road",
                       north_road,
                       Ways::both,
                       1,
                       {{0, Frontage::avenue}, {100, Frontage::open}},
                       0,
                       {at(north_gate_, 0, 14), at(west_cross_, north_road.length_m(), 14)}});
    const Path garden_lane = Path::through({{{0, kMarketNorthM}}, {{kGardenEastM, kMarketNorthM}}});
    builder_.add_road({"garden-lane",
                       garden_lane,
                       Ways::both,
                       1,
                       {{0, Frontage::narrow}},
                       0,
                       {at(market_cross_, 0, 13), at(garden_, garden_lane.length_m(), 11)}});
    const Path loop = Path::through({{{kGardenEastM, kMarketNorthM}},
                                     {{plan_.loop_w, kMarketNorthM}, 16},
                                     {{plan_.loop_w, plan_.loop_n}, 16},
                                     {{kGardenEastM, plan_.loop_n}, 14},
                                     {{kGardenEastM, kMarketNorthM}}});
    builder_.add_road({"garden-loop",
                       loop,
                       Ways::both,
                       1,
                       {{0, Frontage::avenue}},
                       0,
                       {at(garden_, 0, 11), at(garden_, loop.length_m(), 11)}});
  }

  double eastbound_n() const { return plan_.north_gate_n - kMedianM / 2 - kCarriagewayM; }
  double westbound_n() const { return plan_.north_gate_n + kMedianM / 2 + kCarriagewayM; }

  // The dual carriageway, and the exit from its eastern one.
  void add_avenue() {
    constexpr double kGateClearM = 26;
    constexpr double kFromM = -6;  // of the paving at its western end
    const double east_end = plan_.east_e - kRingRadiusM;
    const Path eastbound = Path::through({{{kFromM, eastbound_n()}}, {{east_end, eastbound_n()}}});
    builder_.add_road(
        {"avenue-east",
         eastbound,
         Ways::forwards,
         2,
         {{0, Frontage::avenue}, {180, Frontage::canyon}},
         0,
         {at(north_gate_, 0, kGateClearM), at(exit_, plan_.exit_e - kFromM, kPartingM),
          at(ring_, eastbound.length_m(), kRingClearM)}});
    const Path westbound = Path::through({{{east_end, westbound_n()}}, {{kFromM, westbound_n()}}});
    builder_.add_road(
        {"avenue-west",
         westbound,
         Ways::forwards,
         2,
         {{0, Frontage::avenue}, {200, Frontage::narrow}},
         0,
         {at(ring_, 0, kRingClearM), at(north_gate_, westbound.length_m(), kGateClearM)}});
    add_exit();
  }

  // It parts to the right of the carriageway, runs beside it and turns south.
  void add_exit() {
    const double lane_n = eastbound_n() - kLaneM;
    const double beside_n = lane_n - 2 * kLaneM - 0.3;
    const double bend_n = plan_.west_cross_n + 66;
    const Directed in_lane{{plan_.exit_e - kPartingM, lane_n}, CV_PI / 2};
    const Directed beside{{plan_.exit_e + kPartingM, beside_n}, CV_PI / 2};
    const Path off = Path::through({{beside.at},
                                    {{plan_.ramp_e - 34, beside_n}, 45},
                                    {{plan_.ramp_e, bend_n}, 34},
                                    {{plan_.ramp_e, plan_.west_cross_n}}});
    const Path path = Path::chain({Path::joining(in_lane, beside), off});
    builder_.add_road(
        {"exit-lane",
         path,
         Ways::forwards,
         1,
         {{0, Frontage::avenue}},
         0,
         {at(exit_, path.length_m() - off.length_m(), 0), at(ramp_end_, path.length_m(), 12)}});
  }

  // Station Road; the dead end to its north; Market Street and the bridge across it.
  void add_middle() {
    const double station_n = plan_.west_cross_n;
    builder_.add_road({"station-road",
                       Path::through({{{0, station_n}}, {{plan_.east_e, station_n}}}),
                       Ways::both,
                       1,
                       {{0, Frontage::narrow}, {250, Frontage::avenue}},
                       0,
                       {at(west_cross_, 0, 14), at(mill_cross_, plan_.mill_e),
                        at(ramp_end_, plan_.ramp_e), at(east_cross_, plan_.east_e)}});
    const Path mill_lane = Path::through(
        {{{plan_.mill_e, station_n}}, {{plan_.mill_e, plan_.mill_end_n - kTurningRadiusM}}});
    builder_.add_road({"mill-lane",
                       mill_lane,
                       Ways::both,
                       1,
                       {{0, Frontage::narrow}},
                       0,
                       {at(mill_cross_, 0), at(mill_end_, mill_lane.length_m(), 9)}});
    const std::size_t market_street =
        builder_.add_road({"market-street",
                           Path::through({{{0, kMarketNorthM}}, {{plan_.east_e, kMarketNorthM}}}),
                           Ways::both,
                           1,
                           {{0, Frontage::narrow}, {85, Frontage::open}, {345, Frontage::avenue}},
                           0,
                           {at(market_cross_, 0, 14), at(east_gate_, plan_.east_e)}});
    const Path bridge_street = Path::through({{{plan_.mill_e, station_n}},
                                              {{plan_.mill_e, plan_.bend_n}, 22},
                                              {{plan_.foot_e, plan_.bend_n}, 20},
                                              {{plan_.foot_e, plan_.quay_n}}});
    const std::size_t upper =
        builder_.add_road({"bridge-street",
                           bridge_street,
                           Ways::both,
                           1,
                           {{0, Frontage::avenue}},
                           0,
                           {at(mill_cross_, 0), at(bridge_foot_, bridge_street.length_m())}});
    Cutting cutting;
    cutting.centre = {plan_.mill_e, kMarketNorthM};
    builder_.add_bridge(upper, market_street, cutting);
  }

  // One way: south from Market Street, eastwards on two parallel streets, north to Market Street.
  void add_quay() {
    const double n = plan_.quay_n;
    const Path west =
        Path::through({{{0, kMarketNorthM}}, {{0, n}, 18}, {{plan_.split_e - kPartingM, n}}});
    builder_.add_road({"quay-west",
                       west,
                       Ways::forwards,
                       1,
                       {{0, Frontage::narrow}},
                       0,
                       {at(market_cross_, 0), at(quay_split_, west.length_m(), 0)}});
    for (const auto& [name, side] : {std::pair{"upper-quay", 1}, std::pair{"lower-quay", -1}}) {
      const double apart_n = n + side * kQuayGapM / 2;
      const Path parting = Path::joining({{plan_.split_e - kPartingM, n}, CV_PI / 2},
                                         {{plan_.split_e + kPartingM, apart_n}, CV_PI / 2});
      const Path joining = Path::joining({{plan_.join_e - kPartingM, apart_n}, CV_PI / 2},
                                         {{plan_.join_e + kPartingM, n}, CV_PI / 2});
      const Path straight = Path::through({{parting.end().at}, {joining.start().at}});
      const Path path = Path::chain({parting, straight, joining});
      builder_.add_road({name,
                         path,
                         Ways::forwards,
                         1,
                         {{0, side > 0 ? Frontage::narrow : Frontage::avenue}},
                         0,
                         {at(quay_split_, parting.length_m(), 0),
                          at(quay_join_, path.length_m() - joining.length_m(), 0)}});
    }
    const Path east = Path::through({{{plan_.join_e + kPartingM, n}},
                                     {{plan_.east_e, n}, 18},
                                     {{plan_.east_e, kMarketNorthM}}});
    builder_.add_road(
        {"quay-east",
         east,
         Ways::forwards,
         1,
         {{0, Frontage::avenue}},
         0,
         {at(quay_join_, 0, 0), at(bridge_foot_, plan_.foot_e - plan_.join_e - kPartingM),
          at(east_gate_, east.length_m())}});
  }

  void add_east() {
    const double length = plan_.north_gate_n - kRingRadiusM - kMarketNorthM;
    builder_.add_road({"east-street",
                       Path::through({{{plan_.east_e, kMarketNorthM}},
                                      {{plan_.east_e, plan_.north_gate_n - kRingRadiusM}}}),
                       Ways::both,
                       1,
                       {{0, Frontage::canyon}},
                       0,
                       {at(east_gate_, 0), at(east_cross_, plan_.west_cross_n - kMarketNorthM),
                        at(ring_, length, kRingClearM)}});
    const Path hill_road = Path::through({{{plan_.east_e + kRingRadiusM, plan_.north_gate_n}},
                                          {{plan_.hill_e, plan_.north_gate_n}, 24},
                                          {{plan_.hill_e, plan_.west_cross_n}, 24},
                                          {{plan_.east_e, plan_.west_cross_n}}});
    builder_.add_road({"hill-road",
                       hill_road,
                       Ways::both,
                       1,
                       {{0, Frontage::avenue}, {40, Frontage::open}},
                       0,
                       {at(ring_, 0, kRingClearM), at(east_cross_, hill_road.length_m())}});
  }

  // Fixed for the ground's squares, whose edges are those of the cutting.
  static constexpr double kMarketNorthM = 100;
  static constexpr double kGardenEastM = -46;

  Plan plan_;
  CityBuilder builder_;
  std::size_t north_gate_ = 0, west_cross_ = 0, market_cross_ = 0, garden_ = 0, exit_ = 0,
              ring_ = 0, mill_cross_ = 0, mill_end_ = 0, ramp_end_ = 0, east_cross_ = 0,
              east_gate_ = 0, quay_split_ = 0, quay_join_ = 0, bridge_foot_ = 0;
};

}  // namespace

City lay_out_city(std::uint64_t seed) { return FullCity(seed).build(); }

// A street, a lane that leaves it and comes back, and a place to turn round.
City lay_out_small_city(std::uint64_t seed) {
  cv::RNG random = seeded(seed * 7 + 3);
  const auto near = [&random](double value, double spread) {
    return value + random.uniform(-spread, spread);
  };
  const double first_e = near(62, 3);
  const double second_e = first_e + near(66, 3);
  const double lane_n = near(48, 3);
  const double end_e = second_e + near(62, 3);
  CityBuilder builder(seed);
  builder.terrain().hill_top = {-300, 300};
  builder.terrain().swell_phase = near(0, 3);
  const std::size_t west = builder.add_junction("west-end", JunctionKind::end, {0, 0});
  const std::size_t first = builder.add_junction("first-tee", JunctionKind::tee, {first_e, 0});
  const std::size_t second = builder.add_junction("second-tee", JunctionKind::tee, {second_e, 0});
  const std::size_t east =
      builder.add_junction("east-end", JunctionKind::dead_end, {end_e, 0}, kTurningRadiusM);
  const Path street = Path::through({{{0, 0}}, {{end_e - kTurningRadiusM, 0}}});
  builder.add_road(
      {"high-street",
       street,
       Ways::both,
       1,
       {{0, Frontage::narrow}, {second_e - 20, Frontage::avenue}},
       0,
       {{west, 0, 0, 0}, {first, first_e}, {second, second_e}, {east, street.length_m(), 9, 9}}});
  const Path lane = Path::through(
      {{{first_e, 0}}, {{first_e, lane_n}, 14}, {{second_e, lane_n}, 14}, {{second_e, 0}}});
  builder.add_road({"church-lane",
                    lane,
                    Ways::both,
                    1,
                    {{0, Frontage::avenue}},
                    0,
                    {{first, 0}, {second, lane.length_m()}}});
  builder.add_ring(east, kTurningHalfWidthM, Frontage::avenue);
  return builder.finish({-40, -56}, {end_e + 50, lane_n + 56});
}

}  // namespace milepost::simulator
