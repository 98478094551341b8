#include "mapper/findings/image_findings.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <optional>
#include <system_error>

#include <opencv2/imgproc.hpp>

#include "mapper/findings/trajectory_place.h"
#include "schema/base/digits.h"
#include "schema/base/file.h"
#include "schema/base/median.h"
#include "schema/drive/frame_image.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxImages = 240;

// Consecutive frames of a moving vehicle with one image, byte by byte.
std::optional<Finding> repeated_images(const Drive& drive, const std::vector<Step>& steps) {
  const Frame* first = nullptr;
  std::size_t count = 0;
  for (const Step& step : steps) {
    if (step.length_m() < kLeastStepM) continue;
    const fs::path before = drive.frame_path(drive.frames[step.from]);
    const fs::path after = drive.frame_path(drive.frames[step.from + 1]);
    std::error_code error;
    const auto size = fs::file_size(before, error);
    if (error || size != fs::file_size(after, error) || error) continue;
    const auto bytes = read_text_file(before);
    const auto other = read_text_file(after);
    if (!bytes || !other || *bytes != *other) continue;
    if (count++ == 0) first = &drive.frames[step.from + 1];
  }
  if (count == 0) return std::nullopt;
  return on_trajectory(drive, "repeated_images", *first, count,
                       "frames of the moving vehicle have the image of the frame before",
                       "leave out what the camera did not take anew");
}

// The part of a drive, of so many steps at most, in which the heading changes most.
std::size_t liveliest_part(const std::vector<double>& turns_deg, std::size_t length) {
  double sum = 0;
  double most = -1;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < turns_deg.size(); ++i) {
    sum += turns_deg[i] * turns_deg[i];
    if (i >= length) sum -= turns_deg[i - length] * turns_deg[i - length];
    if (sum > most) {
      most = sum;
      begin = i + 1 > length ? i + 1 - length : 0;
    }
  }
  return begin;
}

// How far frames turn to the right from one to the next, by the shift of what is about the horizon.
class ImageTurns {
 public:
  explicit ImageTurns(const Drive& drive)
      : reader_(drive), scale_(kWidthPx / drive.camera.width_px), camera_(drive.camera) {}

  Result<std::vector<double>> turns_deg(std::size_t begin, std::size_t steps) const {
    std::vector<double> turns;
    cv::Mat before;
    cv::Mat window;
    for (std::size_t i = begin; i <= begin + steps; ++i) {
      const Result<cv::Mat> gray = reader_.gray(i);
      if (!gray) return gray.error();
      const cv::Mat now = horizon_of(*gray);
      if (window.empty()) cv::createHanningWindow(window, now.size(), CV_32F);
      if (!before.empty()) {
        const cv::Point2d shift_px = cv::phaseCorrelate(before, now, window);
        const double focal_px = camera_.pinhole.focal_x_px * scale_;
        turns.push_back(-std::atan(shift_px.x / focal_px) * kDegPerRad);
      }
      before = now;
    }
    return turns;
  }

 private:
  static constexpr double kWidthPx = 320;

  cv::Mat horizon_of(const cv::Mat& gray) const {
    cv::Mat small;
    cv::resize(gray, small, {}, scale_, scale_, cv::INTER_AREA);
    const int middle = static_cast<int>(camera_.pinhole.principal_y_px * scale_);
    const int half = std::max(8, small.rows / 4);
    const int top = std::clamp(middle - half, 0, std::max(0, small.rows - 2 * half));
    cv::Mat band;
    small(cv::Rect(0, top, small.cols, std::min(2 * half, small.rows - top)))
        .convertTo(band, CV_32F);
    return band;
  }

  FrameReader reader_;
  double scale_;
  const Camera& camera_;
};

double correlation(const std::vector<double>& a, const std::vector<double>& b, long lag) {
  double ab = 0;
  double aa = 0;
  double bb = 0;
  for (long i = 0; i < static_cast<long>(a.size()); ++i) {
    const long j = i + lag;
    if (j < 0 || j >= static_cast<long>(b.size())) continue;
    const double x = a[static_cast<std::size_t>(i)];
    const double y = b[static_cast<std::size_t>(j)];
    ab += x * y;
    aa += x * x;
    bb += y * y;
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

// Headings that turn before or after the images do.
Result<std::optional<Finding>> clock_offset(const Drive& drive, const std::vector<Step>& steps) {
  constexpr long kMaxLag = 12;
  constexpr double kAgrees = 0.9;
  constexpr double kBetter = 0.5;       // of what is left unexplained
  constexpr double kLeastTurnDeg = 10;  // altogether
  std::vector<double> turns_deg;
  turns_deg.reserve(drive.frames.size());
  for (std::size_t i = 0; i + 1 < drive.frames.size(); ++i)
    turns_deg.push_back(turn_deg(drive.frames[i].heading_deg, drive.frames[i + 1].heading_deg));
  const std::size_t length = std::min(kMaxImages - 1, turns_deg.size());
  if (length < 3 * static_cast<std::size_t>(kMaxLag)) return std::optional<Finding>();
  const std::size_t begin = liveliest_part(turns_deg, length);
  const std::vector<double> recorded(
      turns_deg.begin() + static_cast<std::ptrdiff_t>(begin),
      turns_deg.begin() + static_cast<std::ptrdiff_t>(begin + length));
  const double turned_deg = std::accumulate(recorded.begin(), recorded.end(), 0.0,
                                            [](double sum, double t) { return sum + std::abs(t); });
  if (turned_deg < kLeastTurnDeg) return std::optional<Finding>();
  const Result<std::vector<double>> seen = ImageTurns(drive).turns_deg(begin, length);
  if (!seen) return seen.error();
  long best = 0;
  for (long lag = -kMaxLag; lag <= kMaxLag; ++lag)
    if (correlation(*seen, recorded, lag) > correlation(*seen, recorded, best)) best = lag;
  const double at_best = correlation(*seen, recorded, best);
  const auto unexplained = [](double r) { return 1 - r * r; };
  if (best == 0 || at_best < kAgrees ||
      unexplained(at_best) > kBetter * unexplained(correlation(*seen, recorded, 0)))
    return std::optional<Finding>();
  std::vector<double> elapsed_s;
  elapsed_s.reserve(steps.size());
  for (const Step& step : steps) elapsed_s.push_back(step.elapsed_s);
  const double off_s = static_cast<double>(best) * median_of(elapsed_s);
  return std::optional(
      on_trajectory(drive, "clock_offset", drive.frames[begin], length,
                    "the headings turn " + fixed(std::abs(off_s), 1) + " s " +
                        (off_s > 0 ? "later" : "earlier") + " than the images do",
                    "correct the clock of the images by as much, or that of the trajectory"));
}

}  // namespace

Result<std::vector<Finding>> image_findings(const Drive& drive, const std::vector<Step>& steps) {
  // What is wrong with all of them is told without reading all.
  if (const auto first = FrameReader(drive).gray(0); !first) return first.error();
  std::vector<Finding> findings;
  if (auto repeated = repeated_images(drive, steps)) findings.push_back(std::move(*repeated));
  const Result<std::optional<Finding>> offset = clock_offset(drive, steps);
  if (!offset) return offset.error();
  if (*offset) findings.push_back(**offset);
  return findings;
}

}  // namespace milepost
