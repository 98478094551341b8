// Time of localizing a frame, including its features, compared with bare OpenCV SIFT of that frame.
// usage: localizer_bench MAP_DRIVE QUERY_DRIVE [METHOD]
#include <cstdio>
#include <filesystem>

#include <opencv2/core/utility.hpp>
#include <opencv2/features2d.hpp>

#include "client/evaluate/baselines/methods.h"
#include "client/evaluate/drive_playback.h"
#include "client/fetch/file_source.h"
#include "client/localize/localizer.h"
#include "mapper/pipeline/build_map.h"
#include "schema/drive/frame_image.h"
#include "schema/feature/extractor.h"
#include "tests/bench/timing.h"

namespace {

// The ratio of times over the same frames.
struct RatioOfSums {
  double seconds = 0;
  double reference_s = 0;

  void add(double more_s, double more_reference_s) {
    seconds += more_s;
    reference_s += more_reference_s;
  }
  double value() const { return seconds / reference_s; }
};

using namespace milepost;

int fail(const Error& error) {
  std::fprintf(stderr, "localizer_bench: %s\n", error.line().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: localizer_bench MAP_DRIVE QUERY_DRIVE [METHOD]\n");
    return 2;
  }
  const Result<Drive> map_drive = read_drive(argv[1]);
  if (!map_drive) return fail(map_drive.error());
  const Result<Drive> query = read_drive(argv[2]);
  if (!query) return fail(query.error());
  const Result<Method> method = method_named(argc > 3 ? argv[3] : kDefaultMethod);
  if (!method) return fail(method.error());

  const std::filesystem::path map =
      std::filesystem::temp_directory_path() / ("localizer_bench-" + map_drive->name + ".map");
  BuildSettings settings;
  settings.lab = true;
  const auto built =
      build_map({*map_drive}, map, settings, 2, [](const BuildProgress&) { return true; });
  if (!built) return fail(built.error());
  Result<std::shared_ptr<MapSource>> source = open_file_source(map);
  if (!source) return fail(source.error());
  LocalizerSettings localizer_settings;
  localizer_settings.method = *method;
  const std::shared_ptr<MapSource> shared_source = std::move(*source);
  Localizer localizer(shared_source, query->camera, localizer_settings);
  Localizer searcher(shared_source, query->camera, localizer_settings);  // finds nothing

  const FeatureParameters& feature = settings.feature;
  const auto sift =
      cv::SIFT::create(feature.max_features, feature.octave_layers, feature.contrast_threshold,
                       feature.edge_threshold, feature.sigma);
  FeatureExtractor extractor(feature, query->camera);
  FeatureSet features;
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
  RatioOfSums all;
  RatioOfSums tracked;
  RatioOfSums searching;
  std::vector<double> bare_ms;
  std::size_t next_gps = 0;
  const FrameReader frames(*query);
  for (std::size_t i = 0; i < query->frames.size(); ++i) {
    const Frame& frame = query->frames[i];
    for (; next_gps < query->gps.size() &&
           query->gps[next_gps].timestamp_s <= frame.timestamp_s + 0.001;
         ++next_gps) {
      const GpsFix& gps = query->gps[next_gps];
      localizer.observe({gps.timestamp_s, gps.position, gps.sigma_m});
    }
    const Result<cv::Mat> gray = frames.gray(i);
    if (!gray) return fail(gray.error());
    const double bare_s = bench::seconds_of(
        [&] { sift->detectAndCompute(*gray, cv::noArray(), keypoints, descriptors); });
    const QueryFrame query_frame{frame.timestamp_s,
                                 [&](const FeatureParameters&) -> const FeatureSet& {
                                   features = extractor.extract(*gray);
                                   return features;
                                 }};
    FixStatus status = FixStatus::initializing;
    const double localizer_s = bench::seconds_of([&] {
      const auto fix = localizer.localize(query_frame);
      if (!fix) fail(fix.error());
      if (fix) status = fix->status;
    });
    // With a GNSS fix at the other end of the road it searches without success.
    const Frame& elsewhere = query->frames[query->frames.size() - 1 - i];
    searcher.observe({frame.timestamp_s, elsewhere.position, 5});
    const double searcher_s = bench::seconds_of([&] {
      const auto fix = searcher.localize(query_frame);
      if (!fix) fail(fix.error());
    });
    bare_ms.push_back(1000 * bare_s);
    all.add(localizer_s, bare_s);
    if (status == FixStatus::tracking) tracked.add(localizer_s, bare_s);
    const bool far = geodesic_distance_m(elsewhere.position, frame.position) > 40;
    if (far && i > 0) searching.add(searcher_s, bare_s);
  }
  std::filesystem::remove(map);
  std::printf(
      "localizer / bare SIFT = %.2f, %.2f over the frames tracked, %.2f where it looks in vain   "
      "(%s, %s, %zu frames, bare %.1f ms)\n",
      all.value(), tracked.value(), searching.value(), method->name.c_str(), query->name.c_str(),
      query->frames.size(), bench::median(bare_ms));
  return 0;
}
