#include "mapper/aerial/storable_walls.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/GeodesicLine.hpp>

#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

using GeographicLib::GeodesicLine;

constexpr double kMaxSpanDeg = 0.1 - 2e-8;         // FORMAT.md 6.4, minus the rounding to steps
constexpr double kShortestM = 0.001;               // about a step of latitude
constexpr std::size_t kMaxMorePieces = 1'000'000;  // than walls
constexpr int kHalvings = 60;                      // of a wall, to find where it meets a meridian

bool is_on_earth(const WallEnd& end) {
  return is_valid(GeoPoint{end.latitude_deg, end.longitude_deg, 0});
}

bool fits_in_tile(const Wall& wall) {
  return std::abs(wall.end.latitude_deg - wall.begin.latitude_deg) <= kMaxSpanDeg &&
         std::abs(wall.end.longitude_deg - wall.begin.longitude_deg) <= kMaxSpanDeg;
}

// Cuts one wall. Longitudes along it continue beyond 180 degrees.
class WallCutter {
 public:
  WallCutter(const Wall& wall, std::vector<Wall>& pieces)
      : wall_(wall),
        line_(GeographicLib::Geodesic::WGS84().InverseLine(
            wall.begin.latitude_deg, wall.begin.longitude_deg, wall.end.latitude_deg,
            wall.end.longitude_deg)),
        pieces_(pieces) {}

  void cut() {
    const Place begin{0, wall_.begin};
    const Place end = at(line_.Distance());
    const double border_deg = end.on_line.longitude_deg > 180 ? 180 : -180;
    if (std::abs(end.on_line.longitude_deg) <= 180) {
      add_pieces(begin, {line_.Distance(), {wall_.end.latitude_deg, end.on_line.longitude_deg}});
      return;
    }
    Place border = meets(border_deg);
    add_pieces(begin, border);
    add_pieces(border, end);
  }

 private:
  struct Place {
    double along_m = 0;
    WallEnd on_line;
  };

  Place at(double along_m) const {
    Place place{along_m, {}};
    double azimuth_deg = 0;
    double ignored = 0;
    line_.GenPosition(false, along_m,
                      GeodesicLine::LATITUDE | GeodesicLine::LONGITUDE | GeodesicLine::LONG_UNROLL,
                      place.on_line.latitude_deg, place.on_line.longitude_deg, azimuth_deg, ignored,
                      ignored, ignored, ignored, ignored);
    return place;
  }

  // Longitude is monotonic along a geodesic.
  Place meets(double meridian_deg) const {
    double before_m = 0;
    double after_m = line_.Distance();
    for (int i = 0; i < kHalvings; ++i) {
      const double middle_m = (before_m + after_m) / 2;
      const bool is_beyond = std::abs(at(middle_m).on_line.longitude_deg) > std::abs(meridian_deg);
      (is_beyond ? after_m : before_m) = middle_m;
    }
    return {after_m, {at(after_m).on_line.latitude_deg, meridian_deg}};
  }

  void add_pieces(const Place& from, const Place& to) {
    const Wall piece{from.on_line, to.on_line, wall_.sigma_m};
    if (fits_in_tile(piece)) {
      add(piece);
    } else if (to.along_m - from.along_m > kShortestM) {
      const Place middle = at((from.along_m + to.along_m) / 2);
      add_pieces(from, middle);
      add_pieces(middle, to);
    }
  }

  // Brings the longitudes of a piece back to [-180, 180].
  void add(Wall piece) {
    const double middle_deg = (piece.begin.longitude_deg + piece.end.longitude_deg) / 2;
    const double turn_deg = middle_deg > 180 ? -360 : middle_deg < -180 ? 360 : 0;
    for (WallEnd* const end : {&piece.begin, &piece.end}) {
      end->longitude_deg = std::clamp(end->longitude_deg + turn_deg, -180.0, 180.0);
    }
    pieces_.push_back(piece);
  }

  const Wall& wall_;
  GeodesicLine line_;
  std::vector<Wall>& pieces_;
};

}  // namespace

Result<std::vector<Wall>> storable_walls(const std::vector<Wall>& walls) {
  std::vector<Wall> pieces;
  pieces.reserve(walls.size());
  for (const Wall& wall : walls) {
    if (!is_on_earth(wall.begin) || !is_on_earth(wall.end)) {
      return Error{ErrorCode::invalid_input, "a wall",
                   "one of its ends is not a position on the Earth",
                   "correct the georeference of the image"};
    }
    if (fits_in_tile(wall)) {
      pieces.push_back(wall);
    } else {
      WallCutter(wall, pieces).cut();
    }
    if (pieces.size() > walls.size() + kMaxMorePieces) {
      return Error{ErrorCode::invalid_input, "walls near a pole",
                   "they would be cut into more than a million pieces",
                   "leave out those near the pole"};
    }
  }
  for (Wall& piece : pieces) piece = quantized(piece);
  std::erase_if(pieces, [](const Wall& piece) { return piece.begin == piece.end; });
  std::ranges::sort(pieces);
  pieces.erase(std::unique(pieces.begin(), pieces.end()), pieces.end());
  return pieces;
}

}  // namespace milepost
