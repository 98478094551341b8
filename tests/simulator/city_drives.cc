#include "tests/simulator/city_drives.h"

#include <algorithm>

#include "tests/simulator/city_way.h"
#include "tests/simulator/paint.h"

namespace milepost::simulator {
namespace {

struct MapPlan {
  const char* says;
  const char* turns;
  int lane;  // on carriageways that have it
};

constexpr MapPlan kMapPlans[] = {
    {"north, the avenue, the roundabout, below the bridge, Station Road",
     "west-cross west-street.2+ north-gate exit ring east-street.2- east-cross east-gate "
     "market-cross west-cross mill-cross ramp-end east-cross",
     1},
    {"the other way: Station Road, below the bridge, the avenue",
     "east-cross ramp-end mill-cross west-cross market-cross east-gate east-cross east-street.2+ "
     "ring north-gate west-street.2- west-cross",
     2},
    {"by the exit and over the bridge",
     "west-cross north-road.1- north-gate exit ramp-end mill-cross bridge-foot east-gate "
     "east-cross east-street.2+ ring",
     1},
    {"both parallel streets and the garden loop",
     "west-cross market-cross quay-split upper-quay.1+ quay-join bridge-foot east-gate "
     "market-cross garden garden-loop.1+ garden market-cross quay-split lower-quay.1+ quay-join "
     "bridge-foot",
     1},
    {"back over the bridge, round at the dead end, over the hill",
     "market-cross quay-split lower-quay.1+ quay-join bridge-foot mill-cross mill-end mill-cross "
     "ramp-end east-cross hill-road.1- ring north-gate",
     2},
    {"one and a quarter times around the roundabout",
     "east-gate east-cross east-street.2+ 1*ring hill-road.1+ east-cross ramp-end mill-cross "
     "mill-end mill-cross "
     "bridge-foot east-gate",
     1},
};

constexpr MapPlan kSmallMapPlans[] = {
    {"around the lane",
     "west-end first-tee second-tee church-lane.1- first-tee high-street.2+ second-tee east-end",
     1},
    {"round at the dead end and into the lane from the other side",
     "first-tee high-street.2+ second-tee east-end second-tee high-street.2- first-tee "
     "church-lane.1+ second-tee east-end",
     1},
};

constexpr const char* kFleetTurns = "west-cross west-street.2+ north-gate exit ring";

CityDrive drive_of(const City& city, const MapPlan& plan, const std::string& name) {
  CityDrive drive;
  drive.name = name;
  drive.says = plan.says;
  drive.passes = passes_through(city, plan.turns);
  for (std::size_t i = 0; i < drive.passes.size(); ++i) {
    Pass& pass = drive.passes[i];
    const auto lanes = static_cast<int>(city.edges[pass.edge].lanes_m.size());
    const bool leaves = i + 1 < drive.passes.size() &&
                        city.junctions[city.edges[pass.edge].to].kind == JunctionKind::exit &&
                        city.edges[drive.passes[i + 1].edge].road != city.edges[pass.edge].road;
    pass.lane = leaves ? 1 : std::min(plan.lane, lanes);
  }
  return drive;
}

// Whether another drive, or this one at another time, passes over the whole edge.
bool is_passed_by_others(const std::vector<CityDrive>& drives, std::size_t edge) {
  for (const CityDrive& drive : drives) {
    for (std::size_t i = 1; i + 1 < drive.passes.size(); ++i) {
      if (drive.passes[i].edge == edge) return true;
    }
  }
  return false;
}

// Drives begin and end somewhere on an edge, if the edge is mapped by others.
void shorten(const City& city, std::vector<CityDrive>& drives) {
  cv::RNG random = seeded(city.seed * 11 + 5);
  for (CityDrive& drive : drives) {
    const double first = random.uniform(0.25, 0.6);
    const double last = random.uniform(0.25, 0.6);
    const auto length_m = [&](const Pass& pass) { return city.edges[pass.edge].middle.length_m(); };
    if (is_passed_by_others(drives, drive.passes.front().edge)) {
      drive.skipped_m = first * length_m(drive.passes.front());
    }
    if (is_passed_by_others(drives, drive.passes.back().edge)) {
      drive.left_out_m = last * length_m(drive.passes.back());
    }
  }
}

template <class Plans>
std::vector<CityDrive> drives_of(const City& city, const Plans& plans) {
  std::vector<CityDrive> drives;
  for (const MapPlan& plan : plans) {
    drives.push_back(drive_of(city, plan, "city-" + std::to_string(drives.size() + 1) + "-map"));
  }
  shorten(city, drives);
  return drives;
}

}  // namespace

std::vector<CityDrive> map_drives(const City& city) { return drives_of(city, kMapPlans); }

std::vector<CityDrive> small_map_drives(const City& city) {
  return drives_of(city, kSmallMapPlans);
}

std::vector<CityDrive> fleet_drives(const City& city) {
  constexpr int kDrives = 6;
  std::vector<CityDrive> drives;
  for (int i = 0; i < kDrives; ++i) {
    const MapPlan plan = {"the avenue, as all others", kFleetTurns, 1 + i % 2};
    drives.push_back(drive_of(city, plan, "city-" + std::to_string(i + 1) + "-map"));
  }
  return drives;
}

CityDrive fleet_tour(const City& city) {
  CityDrive tour = drive_of(city, {"the avenue, as the mapping drives", kFleetTurns, 1}, "");
  tour.is_tour = true;
  return tour;
}

CityDrive strange_tour(const City& city) {
  constexpr MapPlan kPlan = {
      "straight on where no drive did, over an unmapped road and back onto the map",
      "ring north-gate north-road.1+ west-cross mill-cross ramp-end east-cross", 1};
  CityDrive tour = drive_of(city, kPlan, "");
  tour.is_tour = true;
  return tour;
}

}  // namespace milepost::simulator
