// Wall time of building a map, compared with bare OpenCV SIFT on the same frames and threads.
// usage: mapper_bench DRIVE [THREADS [ROUNDS]]
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include <opencv2/core/utility.hpp>
#include <opencv2/features2d.hpp>

#include "mapper/pipeline/build_map.h"
#include "schema/drive/frame_image.h"
#include "tests/bench/timing.h"

namespace {

using namespace milepost;

// Decodes every frame and extracts its features, as the mapper must, and nothing else.
void bare_sift(const Drive& drive, const FeatureParameters& parameters, int threads) {
  const FrameReader frames(drive);
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> workers;
  for (int t = 0; t < threads; ++t) {
    workers.emplace_back([&] {
      const auto sift = cv::SIFT::create(parameters.max_features, parameters.octave_layers,
                                         parameters.contrast_threshold, parameters.edge_threshold,
                                         parameters.sigma);
      std::vector<cv::KeyPoint> keypoints;
      cv::Mat descriptors;
      for (std::size_t i = next++; i < drive.frames.size(); i = next++) {
        sift->detectAndCompute(frames.gray(i).value(), cv::noArray(), keypoints, descriptors);
      }
    });
  }
  for (std::thread& worker : workers) worker.join();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: mapper_bench DRIVE [THREADS [ROUNDS]]\n");
    return 2;
  }
  const int threads =
      argc > 2 ? std::atoi(argv[2]) : static_cast<int>(std::thread::hardware_concurrency());
  const int rounds = argc > 3 ? std::atoi(argv[3]) : 5;
  const Result<Drive> drive = read_drive(argv[1]);
  if (!drive) {
    std::fprintf(stderr, "mapper_bench: %s\n", drive.error().line().c_str());
    return 1;
  }
  const std::filesystem::path map =
      std::filesystem::temp_directory_path() / ("mapper_bench-" + drive->name + ".map");
  cv::setNumThreads(1);

  const BuildSettings settings;
  std::vector<double> bare;
  std::vector<double> mapper;
  std::vector<double> ratios;
  for (int round = 0; round < rounds; ++round) {
    bare.push_back(bench::seconds_of([&] { bare_sift(*drive, settings.feature, threads); }));
    mapper.push_back(bench::seconds_of([&] {
      const auto report =
          build_map({*drive}, map, settings, threads, [](const BuildProgress&) { return true; });
      if (!report) std::fprintf(stderr, "mapper_bench: %s\n", report.error().line().c_str());
    }));
    ratios.push_back(mapper.back() / bare.back());
  }
  std::filesystem::remove(map);
  std::printf(
      "mapper / bare SIFT = %.2f   (%s, %zu frames, %d threads, %d rounds: %.2f s / %.2f s)\n",
      bench::median(ratios), drive->name.c_str(), drive->frames.size(), threads, rounds,
      bench::median(mapper), bench::median(bare));
  return 0;
}
