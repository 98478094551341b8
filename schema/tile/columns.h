// Shared by the tables of all kinds of tiles: writing of arrays item by item, and checks for
// reading.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "schema/base/bytes.h"
#include "schema/base/result.h"
#include "schema/tile/tracklet.h"

namespace milepost {

inline constexpr double kMaxAlongM = 1e8;

// One array of a table, with one value per item.
template <class Value, class Item, class ValueOf>
std::vector<Value> column(const std::vector<Item>& items, ValueOf value_of) {
  std::vector<Value> values;
  values.reserve(items.size());
  for (const Item& item : items) values.push_back(value_of(item));
  return values;
}

// The descriptors of every item, one after the other.
template <class Item, class DescriptorOf>
Bytes descriptor_column(const std::vector<Item>& items, DescriptorOf descriptor_of) {
  Bytes bytes;
  bytes.reserve(items.size() * kDescriptorBytes);
  for (const Item& item : items) {
    const Descriptor& descriptor = descriptor_of(item);
    bytes.insert(bytes.end(), descriptor.begin(), descriptor.end());
  }
  return bytes;
}

// A pixel coordinate in the format's range: 0 to 65535.
std::uint16_t whole_pixel(float px);

// The error of an item, named by `where`, that violates `paragraph` of FORMAT.md.
Error broken_tile(const std::string& where, const std::string& what, const std::string& paragraph);

// Check FORMAT.md 3.4: the head of tiles of every kind, and the scale model of those that have one.
Status check_head(std::string_view segment, double origin_m);
Status check_model(std::uint8_t model);

// "tile SEGMENT/INDEX", for messages about a tile along a segment.
template <class Table>
std::string place_of(const Table& table) {
  return "tile " + table.segment()->str() + "/" + std::to_string(table.index());
}

struct NamedLength {
  const char* name;
  std::size_t length;
};

// Checks that each array has as many values as the array `reference`.
Status check_lengths(const std::string& where, const NamedLength& reference,
                     std::initializer_list<NamedLength> arrays, const std::string& paragraph);

// FORMAT.md 3.6 to 3.10.
Status check_tracklet(const Tracklet& tracklet, const std::string& where);

}  // namespace milepost
