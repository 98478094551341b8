#include "server/catalog/map_lines.h"

#include <algorithm>
#include <utility>

namespace milepost::server {
namespace {

constexpr std::uint64_t kBytesOfAVertex = sizeof(GeoPoint) + sizeof(double) + sizeof(EnuPoint);

std::vector<Bounds> boxes_of(const std::vector<SegmentLine>& lines) {
  std::vector<Bounds> boxes;
  boxes.reserve(lines.size());
  for (const SegmentLine& line : lines) boxes.push_back(line.line.box);
  return boxes;
}

// Around boxes that may lie on both sides of longitude 180: of the two ways to join them the
// narrower.
std::optional<Bounds> joined(const std::vector<Bounds>& boxes) {
  if (boxes.empty()) return std::nullopt;
  // The same with longitudes in [0, 360).
  const auto east_of_0 = [](const Bounds& box) {
    return Bounds{wrapped_360(box.west_deg), box.south_deg, wrapped_360(box.east_deg),
                  box.north_deg};
  };
  Bounds plain = boxes.front();
  Bounds turned = east_of_0(plain);
  for (const Bounds& box : boxes) {
    plain = plain.joined(box);
    turned = turned.joined(east_of_0(box));
  }
  if (plain.east_deg - plain.west_deg <= turned.east_deg - turned.west_deg) return plain;
  const auto back = [](double degrees) { return degrees > 180 ? degrees - 360 : degrees; };
  return Bounds{back(turned.west_deg), turned.south_deg, back(turned.east_deg), turned.north_deg};
}

}  // namespace

MapLines::MapLines(std::vector<SegmentLine> lines)
    : lines_(std::move(lines)), tree_(boxes_of(lines_)), bounds_(joined(boxes_of(lines_))) {
  for (const SegmentLine& line : lines_)
    memory_bytes_ += sizeof(SegmentLine) + kBytesOfAVertex * line.line.line.vertices().size();
}

const RouteLine& MapLines::line(const std::string& segment) const {
  return std::ranges::lower_bound(lines_, segment, {}, &SegmentLine::segment)->line.line;
}

std::vector<NearLine> MapLines::near(const GeoPoint& position, double radius_m) const {
  std::vector<NearLine> found;
  for (const std::size_t number : tree_.near(position, radius_m)) {
    const auto projection = lines_[number].line.nearest_within(position, radius_m);
    if (projection) found.push_back({&lines_[number], *projection});
  }
  return found;
}

}  // namespace milepost::server
