#include "server/catalog/box_tree.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>

#include "schema/geo/near.h"

namespace milepost::server {
namespace {

namespace bg = boost::geometry;

using Corner = bg::model::point<double, 2, bg::cs::cartesian>;  // longitude, latitude
using Box = bg::model::box<Corner>;
using Entry = std::pair<Box, std::size_t>;

Box box_of(const Bounds& bounds) {
  return {{bounds.west_deg, bounds.south_deg}, {bounds.east_deg, bounds.north_deg}};
}

// The parts of bounds on either side of longitude 180.
std::vector<Bounds> parts_of(const Bounds& bounds) {
  if (!bounds.crosses_180()) return {bounds};
  return {{bounds.west_deg, bounds.south_deg, 180, bounds.north_deg},
          {-180, bounds.south_deg, bounds.east_deg, bounds.north_deg}};
}

}  // namespace

struct BoxTree::Impl {
  bg::index::rtree<Entry, bg::index::rstar<16>> tree;
};

BoxTree::BoxTree(const std::vector<Bounds>& boxes) {
  std::vector<Entry> entries;
  entries.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (const Bounds& part : parts_of(boxes[i])) entries.emplace_back(box_of(part), i);
  }
  impl_ = std::make_unique<const Impl>(Impl{{entries.begin(), entries.end()}});
}

BoxTree::~BoxTree() = default;
BoxTree::BoxTree(BoxTree&&) noexcept = default;
BoxTree& BoxTree::operator=(BoxTree&&) noexcept = default;

std::vector<std::size_t> BoxTree::near(const GeoPoint& position, double radius_m) const {
  std::vector<std::size_t> numbers;
  for (const Bounds& part : parts_of(bounds_within(position, radius_m))) {
    std::vector<Entry> found;
    impl_->tree.query(bg::index::intersects(box_of(part)), std::back_inserter(found));
    for (const Entry& entry : found) numbers.push_back(entry.second);
  }
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

}  // namespace milepost::server
