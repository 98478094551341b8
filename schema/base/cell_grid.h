// The grid of cells by which layers without segments are stored and served (FORMAT.md 6).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace milepost {

// A box of latitude and longitude, WGS84. It crosses longitude 180 if west_deg > east_deg.
struct Bounds {
  double west_deg = 0, south_deg = 0, east_deg = 0, north_deg = 0;

  // Whether all values are valid degrees and south_deg <= north_deg.
  bool is_valid() const {
    const auto within = [](double degrees, double limit) { return std::abs(degrees) <= limit; };
    return within(west_deg, 180) && within(east_deg, 180) && within(south_deg, 90) &&
           within(north_deg, 90) && south_deg <= north_deg;
  }
  bool crosses_180() const { return west_deg > east_deg; }

  // Whether the closed boxes intersect. Longitudes are compared as numbers: 180 differs from -180.
  bool meets(const Bounds& other) const {
    return south_deg <= other.north_deg && other.south_deg <= north_deg && longitudes_meet(other);
  }
  // REQUIRES: neither crosses longitude 180.
  Bounds joined(const Bounds& other) const {
    return {std::min(west_deg, other.west_deg), std::min(south_deg, other.south_deg),
            std::max(east_deg, other.east_deg), std::max(north_deg, other.north_deg)};
  }

 private:
  bool longitudes_meet(const Bounds& other) const {
    const bool starts_before_end = west_deg <= other.east_deg;
    const bool ends_after_start = other.west_deg <= east_deg;
    if (crosses_180() && other.crosses_180()) return true;
    if (crosses_180() || other.crosses_180()) return starts_before_end || ends_after_start;
    return starts_before_end && ends_after_start;
  }
};

inline constexpr std::uint32_t kCellsPerDegree = 200;
inline constexpr std::uint32_t kCellRows = 180 * kCellsPerDegree;     // from the south pole
inline constexpr std::uint32_t kCellColumns = 360 * kCellsPerDegree;  // from longitude -180

// A cell's row and column; its number is row * kCellColumns + column.
struct GridCell {
  std::uint32_t row = 0;     // < kCellRows
  std::uint32_t column = 0;  // < kCellColumns

  std::uint32_t number() const { return row * kCellColumns + column; }
  static GridCell numbered(std::uint32_t number) {
    return {number / kCellColumns, number % kCellColumns};
  }

  // The cell that holds a position; the north pole and longitude 180 belong to the last ones.
  // REQUIRES: latitude in [-90, 90], longitude in [-180, 180].
  static GridCell at(double latitude_deg, double longitude_deg) {
    const auto index = [](double degrees, std::uint32_t count) {
      const double from_zero = std::floor(degrees * kCellsPerDegree);
      const std::uint32_t middle = count / 2;
      const auto below = std::min(static_cast<std::uint32_t>(from_zero + middle), count - 1);
      // The product of a border and kCellsPerDegree may be rounded to below the border.
      return below + 1 < count && border_deg(below + 1, count) <= degrees ? below + 1 : below;
    };
    return {index(latitude_deg, kCellRows), index(longitude_deg, kCellColumns)};
  }

  Bounds bounds() const {
    return {border_deg(column, kCellColumns), border_deg(row, kCellRows),
            border_deg(column + 1, kCellColumns), border_deg(row + 1, kCellRows)};
  }

 private:
  // Rounded once, so that both cells at a border compute the same number.
  static double border_deg(std::uint32_t index, std::uint32_t count) {
    const std::uint32_t middle = count / 2;
    return (double{1} * index - middle) / kCellsPerDegree;
  }
};

// Whether `number` is a valid cell number.
inline bool is_cell(std::uint32_t number) { return number < kCellRows * kCellColumns; }

}  // namespace milepost
