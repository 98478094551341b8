#include "mapper/aerial/extraction.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <thread>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "mapper/aerial/block.h"
#include "mapper/aerial/block_plan.h"
#include "mapper/aerial/orthoimage.h"
#include "mapper/aerial/stage_pictures.h"
#include "mapper/aerial/sun_evidence.h"

namespace milepost {
namespace {

constexpr std::size_t kSurveyedBlocks = 16;  // sampled blocks of the image, for shadows and sun
constexpr double kSurveyedScale = 60;        // segmentation scale of its regions
constexpr double kUnknownAzimuthDeg = 180;   // if the shadows give none
constexpr double kUnknownElevationDeg = 45;
constexpr int kMaxSeenPx = 4200;    // side of a block, including its margins
constexpr int kMaxMarginPx = 1000;  // of the margins

// Joins the pieces of one line that two blocks found: they meet at the border between the blocks.
constexpr MergingSettings kSeam{.max_angle_deg = 4, .max_apart_m = 0.3, .max_gap_m = 0.05};

using OnProgress = std::function<bool(const ExtractionProgress&)>;

// Blocks of finer pixels cover less ground, so that memory stays bounded.
std::vector<Block> blocks_at(const Orthoimage& image, const ExtractionSettings& settings,
                             double metres_per_pixel) {
  const auto pixels = [&](double metres) {
    return static_cast<int>(std::ceil(metres / metres_per_pixel));
  };
  const int margin_px = std::min(pixels(settings.margin_m), kMaxMarginPx);
  const int core_px = std::min(pixels(settings.block_m), kMaxSeenPx - 2 * margin_px);
  return blocks_of(image.size(), core_px, margin_px);
}

// A fixed number of blocks at equal distances.
std::vector<Block> sample_of(const std::vector<Block>& blocks) {
  const std::size_t count = std::min(blocks.size(), kSurveyedBlocks);
  std::vector<Block> sample;
  for (std::size_t i = 0; i < count; ++i) sample.push_back(blocks[i * blocks.size() / count]);
  return sample;
}

void count_grey_values(const Picture& picture, std::array<double, 256>& histogram) {
  cv::Mat grey;
  cv::cvtColor(picture.bgr, grey, cv::COLOR_BGR2GRAY);
  for (int y = 0; y < grey.rows; ++y) {
    for (int x = 0; x < grey.cols; ++x) {
      if (picture.covered.at<std::uint8_t>(y, x) != 0) ++histogram[grey.at<std::uint8_t>(y, x)];
    }
  }
}

struct Survey {
  ImageLight light;
  bool sun_was_estimated = false;
};

// Shadow threshold and sun, from sampled blocks at the resolution of regions.
Result<Survey> survey(const ImageSource& source, const ExtractionSettings& settings) {
  const Result<Orthoimage> image = Orthoimage::open(source, settings.regions.metres_per_pixel);
  if (!image) return image.error();
  const std::vector<Block> sample =
      sample_of(blocks_at(*image, settings, settings.regions.metres_per_pixel));
  std::array<double, 256> histogram{};
  for (const Block& block : sample) {
    const Result<Picture> picture = image->read(block.core);
    if (!picture) return picture.error();
    count_grey_values(*picture, histogram);
  }
  Survey found;
  found.light.shadow_threshold = shadow_threshold(histogram, settings.shadows);
  found.light.sun.elevation_deg = settings.sun_elevation_deg.value_or(kUnknownElevationDeg);
  if (settings.sun_azimuth_deg) {
    found.light.sun.azimuth_deg = *settings.sun_azimuth_deg;
    return found;
  }
  RegionSettings houses = settings.regions;
  houses.scales = {kSurveyedScale};
  SunEvidence evidence;
  for (const Block& block : sample) {
    const Result<Picture> picture = image->read(block.core);
    if (!picture) return picture.error();
    evidence.add(
        region_maps(*picture, found.light.shadow_threshold, settings.clutter, houses).front());
  }
  const std::optional<double> azimuth_deg = evidence.azimuth_deg();
  found.sun_was_estimated = azimuth_deg.has_value();
  found.light.sun.azimuth_deg = azimuth_deg.value_or(kUnknownAzimuthDeg);
  return found;
}

// The ground of a core. It is extended at the image's border, where lines may lie on the border.
GroundBox ground_box(const Block& block, const Picture& picture, const cv::Size& image) {
  const double pixel_m = picture.grid.metres_per_pixel;
  const double beyond_m = 1;
  const cv::Rect& core = block.core;
  GroundBox box;
  box.west_m = picture.grid.west_m + (core.x - block.seen.x) * pixel_m;
  box.north_m = picture.grid.north_m - (core.y - block.seen.y) * pixel_m;
  box.east_m = box.west_m + core.width * pixel_m;
  box.south_m = box.north_m - core.height * pixel_m;
  if (core.x == 0) box.west_m -= beyond_m;
  if (core.y == 0) box.north_m += beyond_m;
  if (core.br().x == image.width) box.east_m += beyond_m;
  if (core.br().y == image.height) box.south_m -= beyond_m;
  return box;
}

// Processes all blocks on several threads.
class Extraction {
 public:
  Extraction(const Orthoimage& image, const ImageLight& light, const ExtractionSettings& settings,
             const std::filesystem::path& pictures, const OnProgress& on_progress)
      : image_(image),
        light_(light),
        settings_(settings),
        pictures_(pictures),
        on_progress_(on_progress),
        blocks_(blocks_at(image, settings, settings.metres_per_pixel)),
        found_(blocks_.size()) {}

  Result<WallLines> run(int jobs) {
    std::vector<std::thread> others;
    for (int i = 1; i < jobs; ++i) others.emplace_back([this] { work(); });
    work();
    for (std::thread& other : others) other.join();
    if (failure_) return *failure_;
    WallLines all;
    for (const WallLines& lines : found_) all.insert(all.end(), lines.begin(), lines.end());
    return blocks_.size() > 1 ? merged(std::move(all), kSeam) : all;
  }

  // After run(): whether any block is not fully transparent.
  bool shows_anything() const { return shows_anything_; }

 private:
  void work() {
    for (std::size_t i = next_++; i < blocks_.size(); i = next_++) {
      const Status status = extract(i);
      const std::lock_guard lock(mutex_);
      ++done_;
      if (!status && !failure_) failure_ = status.error();
      if (!failure_ && !on_progress_({done_, blocks_.size()})) {
        failure_ = Error{ErrorCode::cancelled, "", "stopped on request, no map was written", ""};
      }
      if (failure_) return;
    }
  }

  Status extract(std::size_t number) {
    const Block& block = blocks_[number];
    const Result<Picture> picture = [&] {
      const std::lock_guard lock(image_mutex_);
      return image_.read(block.seen);
    }();
    if (!picture) return picture.error();
    if (cv::countNonZero(picture->covered) == 0) return ok_status();
    shows_anything_ = true;
    const StagePictures pictures(pictures_, "block" + std::to_string(number));
    found_[number] = clipped(block_walls(*picture, light_, settings_, pictures),
                             ground_box(block, *picture, image_.size()));
    return ok_status();
  }

  const Orthoimage& image_;
  const ImageLight& light_;
  const ExtractionSettings& settings_;
  const std::filesystem::path& pictures_;
  const OnProgress& on_progress_;
  std::vector<Block> blocks_;
  std::vector<WallLines> found_;  // by block: each is written by the thread that processes it
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> shows_anything_ = false;
  std::mutex image_mutex_;  // guards image_
  std::mutex mutex_;        // guards done_ and failure_
  std::size_t done_ = 0;
  std::optional<Error> failure_;
};

}  // namespace

Result<ExtractedWalls> extract_walls(const ImageSource& source, const ExtractionSettings& settings,
                                     int jobs, const std::filesystem::path& pictures,
                                     const OnProgress& on_progress) {
  const Result<Survey> surveyed = survey(source, settings);
  if (!surveyed) return surveyed.error();
  const Result<Orthoimage> image = Orthoimage::open(source, settings.metres_per_pixel);
  if (!image) return image.error();
  Extraction extraction(*image, surveyed->light, settings, pictures, on_progress);
  Result<WallLines> lines = extraction.run(jobs);
  if (!lines) return lines.error();
  if (!settings.without.contains(Stage::merging)) *lines = merged(*lines, settings.merging);
  if (!settings.without.contains(Stage::closure)) *lines = closed(*lines, settings.closure);
  if (!settings.without.contains(Stage::corners)) {
    *lines = with_corners(*lines, settings.corners);
  }
  return ExtractedWalls{image->frame(),
                        image->bounds(),
                        image->bands(),
                        extraction.shows_anything(),
                        std::move(*lines),
                        surveyed->light.sun,
                        surveyed->sun_was_estimated,
                        surveyed->light.shadow_threshold};
}

}  // namespace milepost
