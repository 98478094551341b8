#include "tests/simulator/path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace milepost::simulator {
namespace {

double heading_of(const cv::Vec2d& direction) { return std::atan2(direction[0], direction[1]); }

}  // namespace

cv::Vec2d forward_of(double heading_rad) { return {std::sin(heading_rad), std::cos(heading_rad)}; }
cv::Vec2d right_of(double heading_rad) { return {std::cos(heading_rad), -std::sin(heading_rad)}; }

void Path::append(double length_m, double curvature_per_m, const cv::Vec2d& start,
                  double heading_rad) {
  const double from_m = pieces_.empty() ? 0 : pieces_.back().from_m + pieces_.back().length_m;
  if (length_m > 1e-9) pieces_.push_back({from_m, length_m, start, heading_rad, curvature_per_m});
}

Path Path::through(const std::vector<Bend>& bends) {
  Path path;
  cv::Vec2d at = bends.front().at;
  for (std::size_t i = 1; i < bends.size(); ++i) {
    const cv::Vec2d in = bends[i].at - bends[i - 1].at;
    const double heading = heading_of(in);
    if (i + 1 == bends.size()) {
      path.append(cv::norm(bends[i].at - at), 0, at, heading);
      break;
    }
    const cv::Vec2d out = bends[i + 1].at - bends[i].at;
    const double turn = std::remainder(heading_of(out) - heading, 2 * std::numbers::pi);
    const double cut_m = bends[i].radius_m * std::tan(std::abs(turn) / 2);
    const cv::Vec2d arc_start = bends[i].at - in * (cut_m / cv::norm(in));
    path.append(cv::norm(arc_start - at), 0, at, heading);
    const double curvature = (turn > 0 ? 1 : -1) / bends[i].radius_m;
    path.append(std::abs(turn) * bends[i].radius_m, curvature, arc_start, heading);
    at = bends[i].at + out * (cut_m / cv::norm(out));
  }
  return path;
}

Path Path::arc(const Directed& from, double length_m, double curvature_per_m) {
  Path path;
  path.append(length_m, curvature_per_m, from.at, from.heading_rad);
  return path;
}

Path Path::circle(const cv::Vec2d& centre, double radius_m) {
  Path path;
  path.append(2 * std::numbers::pi * radius_m, -1 / radius_m, centre + cv::Vec2d(radius_m, 0), 0);
  return path;
}

// The arc from a place, in its direction, to a point.
void Path::append_arc(const Directed& from, const cv::Vec2d& to) {
  const cv::Vec2d chord = to - from.at;
  const double chord_m = cv::norm(chord);
  const double half_turn =
      std::remainder(heading_of(chord) - from.heading_rad, 2 * std::numbers::pi);
  const double curvature = 2 * std::sin(half_turn) / chord_m;
  const bool is_straight = std::abs(curvature) < 1e-7;
  append(is_straight ? chord_m : 2 * half_turn / curvature, is_straight ? 0 : curvature, from.at,
         from.heading_rad);
}

// The arcs meet in the middle between two points that are equally far ahead of the first place and
// behind the second.
Path Path::joining(const Directed& from, const Directed& to) {
  const cv::Vec2d out = forward_of(from.heading_rad);
  const cv::Vec2d in = forward_of(to.heading_rad);
  const cv::Vec2d chord = to.at - from.at;
  const double a = 2 * (1 - out.dot(in));
  const double b = chord.dot(out + in);
  const double c = chord.dot(chord);
  const double ahead_m = a < 1e-9 ? c / (2 * b) : (std::sqrt(b * b + a * c) - b) / a;
  const cv::Vec2d middle = (from.at + out * ahead_m + to.at - in * ahead_m) * 0.5;
  Path path;
  path.append_arc(from, middle);
  path.append_arc(path.end(), to.at);
  return path;
}

Path Path::chain(const std::vector<Path>& paths) {
  Path whole;
  for (const Path& path : paths) {
    for (const Piece& piece : path.pieces_) {
      whole.append(piece.length_m, piece.curvature_per_m, piece.start, piece.heading_rad);
    }
  }
  return whole;
}

Path Path::shifted(double lateral_m) const {
  Path path;
  for (const Piece& piece : pieces_) {
    const double stretch = 1 - piece.curvature_per_m * lateral_m;
    path.append(piece.length_m * stretch, piece.curvature_per_m / stretch,
                piece.start + right_of(piece.heading_rad) * lateral_m, piece.heading_rad);
  }
  return path;
}

Path Path::part(double from_m, double to_m) const {
  Path path;
  for (const Piece& piece : pieces_) {
    const double begin_m = std::max(from_m - piece.from_m, 0.0);
    const double end_m = std::min(to_m - piece.from_m, piece.length_m);
    if (begin_m >= end_m) continue;
    path.append(end_m - begin_m, piece.curvature_per_m, point_of(piece, begin_m),
                piece.heading_rad + piece.curvature_per_m * begin_m);
  }
  return path;
}

Path Path::reversed() const {
  Path path;
  for (auto piece = pieces_.rbegin(); piece != pieces_.rend(); ++piece) {
    const double heading = piece->heading_rad + piece->curvature_per_m * piece->length_m;
    path.append(piece->length_m, -piece->curvature_per_m, point_of(*piece, piece->length_m),
                heading + std::numbers::pi);
  }
  return path;
}

const Path::Piece& Path::piece_at(double along_m) const {
  const auto after =
      std::upper_bound(pieces_.begin(), pieces_.end(), along_m,
                       [](double along, const Piece& piece) { return along < piece.from_m; });
  return after == pieces_.begin() ? pieces_.front() : *std::prev(after);
}

cv::Vec2d Path::point_of(const Piece& piece, double local_m) {
  const double k = piece.curvature_per_m;
  if (k == 0) return piece.start + forward_of(piece.heading_rad) * local_m;
  const double heading = piece.heading_rad + k * local_m;
  return piece.start + (right_of(piece.heading_rad) - right_of(heading)) * (1 / k);
}

cv::Vec2d Path::position_at(const RoadPlace& place) const {
  const Piece& piece = piece_at(place.along_m);
  const double local_m = place.along_m - piece.from_m;
  const double heading = piece.heading_rad + piece.curvature_per_m * local_m;
  return point_of(piece, local_m) + right_of(heading) * place.lateral_m;
}

double Path::heading_rad_at(double along_m) const {
  const Piece& piece = piece_at(along_m);
  return piece.heading_rad + piece.curvature_per_m * (along_m - piece.from_m);
}

double Path::curvature_per_m_at(double along_m) const { return piece_at(along_m).curvature_per_m; }

double Path::nearest_of(const Piece& piece, const cv::Vec2d& position) {
  const double k = piece.curvature_per_m;
  double local_m = 0;
  if (k == 0) {
    local_m = (position - piece.start).dot(forward_of(piece.heading_rad));
  } else {
    // From the arc's centre the position lies on the radius of the nearest point.
    const double side = k > 0 ? 1 : -1;
    const cv::Vec2d to_centre =
        (piece.start + right_of(piece.heading_rad) * (1 / k) - position) * side;
    const double heading = std::atan2(-to_centre[1], to_centre[0]);
    const double half = piece.length_m * std::abs(k) / 2;
    const double turned =
        std::remainder((heading - piece.heading_rad) * side - half, 2 * std::numbers::pi);
    local_m = (turned + half) / std::abs(k);
  }
  return std::clamp(local_m, 0.0, piece.length_m);
}

RoadPlace Path::place_of(const cv::Vec2d& position) const {
  RoadPlace nearest;
  double least = std::numeric_limits<double>::infinity();
  for (const Piece& piece : pieces_) {
    const double local_m = nearest_of(piece, position);
    const cv::Vec2d offset = position - point_of(piece, local_m);
    const double distance = cv::norm(offset);
    if (distance >= least) continue;
    least = distance;
    const double heading = piece.heading_rad + piece.curvature_per_m * local_m;
    nearest = {piece.from_m + local_m, offset.dot(right_of(heading)) < 0 ? -distance : distance};
  }
  return nearest;
}

}  // namespace milepost::simulator
