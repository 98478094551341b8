// Time of global localization per frame, on one thread, compared with that of bare OpenCV for the
// frame's line segments and features, which global localization uses.
// usage: find_bench FOOTPRINTS DRIVE [PARTICLES]
#include <cstdio>
#include <cstdlib>

#include <opencv2/core/utility.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "client/global/global_localizer.h"
#include "mapper/aerial/footprints.h"
#include "schema/drive/frame_image.h"
#include "tests/bench/timing.h"

namespace {

using namespace milepost;

int fail(const Error& error) {
  std::fprintf(stderr, "find_bench: %s\n", error.line().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: find_bench FOOTPRINTS DRIVE [PARTICLES]\n");
    return 2;
  }
  const Result<Footprints> footprints = read_footprints(argv[1]);
  if (!footprints) return fail(footprints.error());
  const Result<Drive> drive = read_drive(argv[2]);
  if (!drive) return fail(drive.error());
  GlobalLocalizerSettings settings;
  if (argc > 3) settings.particles = std::strtoul(argv[3], nullptr, 10);
  GlobalLocalizer localizer(footprints->walls, drive->camera, settings);

  cv::setNumThreads(1);
  const auto segments = cv::createLineSegmentDetector();
  const auto orb = cv::ORB::create(ScenePointSettings{}.features);
  std::vector<cv::Vec4f> ends;
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
  std::vector<double> bare_ms;
  std::vector<double> find_ms;
  double bare_total_s = 0;
  double find_total_s = 0;
  std::size_t next_reading = 0;
  const FrameReader frames(*drive);
  for (std::size_t i = 0; i < drive->frames.size(); ++i) {
    const double timestamp_s = drive->frames[i].timestamp_s;
    for (; next_reading < drive->odometry.size() &&
           drive->odometry[next_reading].timestamp_s <= timestamp_s;
         ++next_reading) {
      localizer.observe(drive->odometry[next_reading]);
    }
    const Result<cv::Mat> gray = frames.gray(i);
    if (!gray) return fail(gray.error());
    const double bare_s = bench::seconds_of([&] {
      segments->detect(*gray, ends);
      orb->detectAndCompute(*gray, cv::noArray(), keypoints, descriptors);
    });
    const double find_s = bench::seconds_of([&] { localizer.find(*gray, timestamp_s); });
    bare_total_s += bare_s;
    find_total_s += find_s;
    bare_ms.push_back(1000 * bare_s);
    find_ms.push_back(1000 * find_s);
  }
  const auto frame_count = static_cast<double>(drive->frames.size());
  std::printf(
      "finder / bare LSD and ORB = %.2f of the sums   (%s, %zu particles, %zu frames; finder %.1f "
      "ms "
      "a frame in the mean, %.1f in the median; bare %.1f ms)\n",
      find_total_s / bare_total_s, drive->name.c_str(), settings.particles, drive->frames.size(),
      1000 * find_total_s / frame_count, bench::median(find_ms), bench::median(bare_ms));
  return 0;
}
