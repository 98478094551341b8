#include "mapper/aerial/progressive_hough.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

namespace milepost {
namespace {

constexpr int kAngles = 180;  // of a line's normal, one degree apart
constexpr double kRadPerAngle = std::numbers::pi / kAngles;
constexpr std::uint8_t kRests = 1 << 7;  // an edge that is inactive until the pass ends

int wrapped_angle(int angle) { return (angle + kAngles) % kAngles; }

// The angle between two undirected lines, in degrees.
int turn_between(int a, int b) {
  const int turn = std::abs(a - b);
  return std::min(turn, kAngles - turn);
}

// The orientation of the gradient at each pixel, 0 to 179 degrees: the normal of a line through it.
cv::Mat normals_of(const Gradient& gradient) {
  cv::Mat normals(gradient.x.size(), CV_8UC1);
  for (int y = 0; y < normals.rows; ++y) {
    const auto* const gx = gradient.x.ptr<std::int16_t>(y);
    const auto* const gy = gradient.y.ptr<std::int16_t>(y);
    for (int x = 0; x < normals.cols; ++x) {
      const double angle_rad = std::atan2(gy[x], gx[x]);
      const int angle = static_cast<int>(std::lround(angle_rad / kRadPerAngle));
      normals.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(wrapped_angle(angle));
    }
  }
  return normals;
}

// The votes of edges for lines, in Hough space: the angle of the normal, and the distance from the
// top left pixel.
class Accumulator {
 public:
  Accumulator(const cv::Size& size, int spread) : spread_(spread) {
    for (int angle = 0; angle < kAngles; ++angle) {
      cosine_[angle] = std::cos(angle * kRadPerAngle);
      sine_[angle] = std::sin(angle * kRadPerAngle);
    }
    offset_ = size.width + size.height;
    votes_.create(kAngles, 2 * offset_ + 1, CV_16SC1);
  }

  void clear() { votes_.setTo(0); }

  // Adds the pixel's votes; returns the angle of the line through it with the most votes, `most`.
  int vote(const cv::Point& pixel, int normal, int& most) {
    int best = normal;
    most = 0;
    for (int turn = -spread_; turn <= spread_; ++turn) {
      const int angle = wrapped_angle(normal + turn);
      const int votes = ++at(pixel, angle);
      if (votes <= most) continue;
      most = votes;
      best = angle;
    }
    return best;
  }

  void take_back(const cv::Point& pixel, int normal) {
    for (int turn = -spread_; turn <= spread_; ++turn) --at(pixel, wrapped_angle(normal + turn));
  }

 private:
  std::int16_t& at(const cv::Point& pixel, int angle) {
    const double distance = pixel.x * cosine_[angle] + pixel.y * sine_[angle];
    return votes_.at<std::int16_t>(angle, offset_ + static_cast<int>(std::lround(distance)));
  }

  int spread_;
  int offset_ = 0;
  std::array<double, kAngles> cosine_{};
  std::array<double, kAngles> sine_{};
  cv::Mat votes_;
};

// The edges on a line, and how much of it they cover.
struct Trace {
  std::vector<cv::Point> edges;
  int steps_with_edge = 0;
  double length_px = 0;
};

// The least-squares line through the edges, from the first to the last.
PixelLine fitted(const std::vector<cv::Point>& edges) {
  cv::Vec4f fit;  // direction, then a point
  cv::fitLine(edges, fit, cv::DIST_L2, 0, 0.01, 0.01);
  const Eigen::Vector2d direction(fit[0], fit[1]);
  const Eigen::Vector2d point(fit[2], fit[3]);
  double first = 0;
  double last = 0;
  for (const cv::Point& edge : edges) {
    const double along = direction.dot(Eigen::Vector2d(edge.x, edge.y) - point);
    first = std::min(first, along);
    last = std::max(last, along);
  }
  return {point + first * direction, point + last * direction};
}

class Transform {
 public:
  Transform(const std::vector<cv::Mat>& maps, const Gradient& gradient, double metres_per_pixel,
            const HoughSettings& settings)
      : maps_(maps),
        metres_per_pixel_(metres_per_pixel),
        settings_(settings),
        normals_(normals_of(gradient)),
        alive_(cv::Mat::zeros(normals_.size(), CV_8UC1)),
        voted_(cv::Mat::zeros(normals_.size(), CV_8UC1)),
        votes_(normals_.size(), static_cast<int>(std::lround(settings.max_turn_deg))),
        random_(settings.seed) {
    for (std::size_t map = 0; map < maps.size(); ++map) {
      cv::bitwise_or(alive_, cv::Scalar::all(1 << map), alive_, maps[map]);
    }
    cv::Mat edges;
    maps.back().convertTo(edges, CV_32F, 1.0 / 255);
    const int window = std::max(1, static_cast<int>(settings.density_window_m / metres_per_pixel));
    cv::blur(edges, density_, {window, window});
  }

  std::vector<PixelLine> run() {
    for (int round = 0; round < settings_.rounds; ++round) {
      const double done = settings_.rounds > 1 ? round / (settings_.rounds - 1.0) : 1;
      const double least_m =
          settings_.longest_m * std::pow(settings_.shortest_m / settings_.longest_m, done);
      for (std::size_t map = 0; map < maps_.size(); ++map) {
        pass(static_cast<std::uint8_t>(1 << map), least_m / metres_per_pixel_);
      }
    }
    return std::move(lines_);
  }

 private:
  // Extracts the lines of one map that have at least this length.
  void pass(std::uint8_t map, double least_px) {
    votes_.clear();
    voted_.setTo(0);
    alive_ &= cv::Scalar::all(static_cast<std::uint8_t>(~kRests));
    for (const cv::Point& pixel : shuffled_edges(map)) {
      if (!votes_in(map, pixel)) continue;
      int most = 0;
      const int angle = votes_.vote(pixel, normals_.at<std::uint8_t>(pixel), most);
      voted_.at<std::uint8_t>(pixel) = 1;
      const double needed_px = least_px * crowding(pixel);
      if (most < settings_.min_support * needed_px) continue;
      const Trace found = trace(map, pixel, angle);
      if (found.length_px >= needed_px &&
          found.steps_with_edge >= settings_.min_support * found.length_px) {
        const PixelLine line = fitted(found.edges);
        use_up(line);
        lines_.push_back(line);
      }
      for (const cv::Point& edge : found.edges) rest(edge);
    }
  }

  bool votes_in(std::uint8_t map, const cv::Point& pixel) const {
    const std::uint8_t state = alive_.at<std::uint8_t>(pixel);
    return (state & map) != 0 && (state & kRests) == 0;
  }

  // The factor by which a line must be longer where edges are dense.
  double crowding(const cv::Point& pixel) const {
    return std::max(1.0, density_.at<float>(pixel) / settings_.dense_share);
  }

  std::vector<cv::Point> shuffled_edges(std::uint8_t map) {
    cv::Mat in_map;
    cv::bitwise_and(alive_, cv::Scalar::all(map), in_map);
    std::vector<cv::Point> edges;
    cv::findNonZero(in_map, edges);
    for (std::size_t left = edges.size(); left > 1; --left) {
      std::swap(edges[left - 1], edges[random_.uniform(0, static_cast<int>(left))]);
    }
    return edges;
  }

  // Follows the line from the pixel in both directions until a gap is too long.
  Trace trace(std::uint8_t map, const cv::Point& start, int angle) const {
    Trace trace;
    const Eigen::Vector2d normal(std::cos(angle * kRadPerAngle), std::sin(angle * kRadPerAngle));
    const int max_gap = static_cast<int>(settings_.max_gap_m / metres_per_pixel_);
    for (const double sense : {1.0, -1.0}) {
      const Eigen::Vector2d step(-sense * normal.y(), sense * normal.x());
      int reached = 0;
      for (int i = sense > 0 ? 0 : 1; i - reached <= max_gap + 1; ++i) {
        const Eigen::Vector2d middle = Eigen::Vector2d(start.x, start.y) + i * step;
        if (!take_step(map, middle, normal, angle, trace.edges)) continue;
        reached = i;
        ++trace.steps_with_edge;
      }
      trace.length_px += reached;
    }
    return trace;
  }

  // Adds the edges in the corridor of the line at `middle`. Returns whether there is one.
  bool take_step(std::uint8_t map, const Eigen::Vector2d& middle, const Eigen::Vector2d& normal,
                 int angle, std::vector<cv::Point>& edges) const {
    const int half = static_cast<int>(std::lround(settings_.corridor_m / metres_per_pixel_));
    bool found = false;
    for (int across = -half; across <= half; ++across) {
      const cv::Point pixel = nearest_pixel(middle + across * normal);
      if (!contains(pixel) || !votes_in(map, pixel) || !runs_along(pixel, angle)) continue;
      edges.push_back(pixel);
      found = true;
    }
    return found;
  }

  static cv::Point nearest_pixel(const Eigen::Vector2d& at) {
    return {static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y()))};
  }

  bool contains(const cv::Point& pixel) const {
    return pixel.inside({0, 0, alive_.cols, alive_.rows});
  }

  bool runs_along(const cv::Point& pixel, int angle) const {
    return turn_between(normals_.at<std::uint8_t>(pixel), angle) <= settings_.max_turn_deg;
  }

  // Removes the edges near the line from all maps.
  void use_up(const PixelLine& line) {
    const Eigen::Vector2d way = line.end_px - line.begin_px;
    const Eigen::Vector2d direction = way.normalized();
    const Eigen::Vector2d normal(-direction.y(), direction.x());
    const double angle_rad = std::atan2(normal.y(), normal.x());
    const int angle = wrapped_angle(static_cast<int>(std::lround(angle_rad / kRadPerAngle)));
    const double half_px = settings_.clearance_m / metres_per_pixel_;
    const int steps_along = static_cast<int>(2 * way.norm());  // of half a pixel
    const int steps_across = static_cast<int>(2 * half_px);
    for (int along = 0; along <= steps_along; ++along) {
      for (int across = -steps_across; across <= steps_across; ++across) {
        const cv::Point pixel =
            nearest_pixel(line.begin_px + along / 2.0 * direction + across / 2.0 * normal);
        if (contains(pixel) && alive_.at<std::uint8_t>(pixel) != 0 && runs_along(pixel, angle)) {
          rest(pixel);
          alive_.at<std::uint8_t>(pixel) = 0;
        }
      }
    }
  }

  // Deactivates the edge until the pass ends.
  void rest(const cv::Point& edge) {
    if (voted_.at<std::uint8_t>(edge) != 0) {
      votes_.take_back(edge, normals_.at<std::uint8_t>(edge));
      voted_.at<std::uint8_t>(edge) = 0;
    }
    alive_.at<std::uint8_t>(edge) |= kRests;
  }

  const std::vector<cv::Mat>& maps_;
  double metres_per_pixel_;
  const HoughSettings& settings_;
  cv::Mat normals_;  // degrees
  cv::Mat alive_;    // bit i: an edge of map i that no line has used up; kRests
  cv::Mat voted_;    // 1: the edge's votes are in the accumulator
  cv::Mat density_;  // share of edge pixels around
  Accumulator votes_;
  cv::RNG random_;
  std::vector<PixelLine> lines_;
};

}  // namespace

std::vector<PixelLine> progressive_hough(const std::vector<cv::Mat>& maps, const Gradient& gradient,
                                         double metres_per_pixel, const HoughSettings& settings) {
  return Transform(maps, gradient, metres_per_pixel, settings).run();
}

std::vector<PixelLine> plain_hough(const cv::Mat& map, double metres_per_pixel,
                                   const HoughSettings& settings) {
  const double least_px = settings.shortest_m / metres_per_pixel;
  std::vector<cv::Vec4i> found;
  cv::HoughLinesP(map, found, 1, kRadPerAngle,
                  static_cast<int>(std::lround(settings.min_support * least_px)), least_px,
                  settings.max_gap_m / metres_per_pixel);
  std::vector<PixelLine> lines;
  lines.reserve(found.size());
  for (const cv::Vec4i& line : found) {
    lines.push_back({Eigen::Vector2d(line[0], line[1]), Eigen::Vector2d(line[2], line[3])});
  }
  return lines;
}

}  // namespace milepost
