#include "mapper/findings/image_findings.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <optional>
#include <system_error>

#include "mapper/findings/image_motion.h"
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

// How far the frames of a part of a drive turn to the right from one to the next.
Result<std::vector<double>> seen_turns_deg(const Drive& drive, std::size_t begin,
                                           std::size_t steps) {
  const FrameReader reader(drive);
  ImageMotion motion(drive.camera);
  std::vector<double> turns;
  for (std::size_t i = begin; i <= begin + steps; ++i) {
    const Result<cv::Mat> gray = reader.gray(i);
    if (!gray) return gray.error();
    if (const auto moved = motion.to(*gray)) turns.push_back(moved->turn_deg);
  }
  return turns;
}

double correlation_at(const std::vector<double>& seen, const std::vector<double>& recorded,
                      long lag) {
  std::vector<double> a;
  std::vector<double> b;
  for (long i = 0; i < static_cast<long>(seen.size()); ++i) {
    const long j = i + lag;
    if (j < 0 || j >= static_cast<long>(recorded.size())) continue;
    a.push_back(seen[static_cast<std::size_t>(i)]);
    b.push_back(recorded[static_cast<std::size_t>(j)]);
  }
  return correlation(a, b);
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
  const Result<std::vector<double>> seen = seen_turns_deg(drive, begin, length);
  if (!seen) return seen.error();
  long best = 0;
  for (long lag = -kMaxLag; lag <= kMaxLag; ++lag)
    if (correlation_at(*seen, recorded, lag) > correlation_at(*seen, recorded, best)) best = lag;
  const double at_best = correlation_at(*seen, recorded, best);
  const auto unexplained = [](double r) { return 1 - r * r; };
  if (best == 0 || at_best < kAgrees ||
      unexplained(at_best) > kBetter * unexplained(correlation_at(*seen, recorded, 0)))
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
