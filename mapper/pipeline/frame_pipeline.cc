#include "mapper/pipeline/frame_pipeline.h"

#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include "schema/drive/frame_image.h"
#include "schema/feature/extractor.h"
#include "schema/feature/wisurf.h"

namespace milepost {

struct FramePipeline::Impl {
  // Constant after construction.
  const FrameReader reader;
  const std::vector<std::size_t> frame_indices;
  const Camera camera;
  const FeatureParameters parameters;
  const bool images;
  const std::size_t look_ahead;

  // Protected by `mutex`.
  std::mutex mutex;
  std::condition_variable work_allowed;
  std::condition_variable result_ready;
  std::size_t next_to_start = 0;
  std::size_t next_to_hand_out = 0;
  std::map<std::size_t, Result<ExtractedFrame>> done;
  bool stopping = false;

  std::vector<std::thread> threads;

  Impl(const Drive& from, std::vector<std::size_t> indices, const FeatureParameters& with,
       bool with_images, int count)
      : reader(from),
        frame_indices(std::move(indices)),
        camera(from.camera),
        parameters(with),
        images(with_images),
        look_ahead(2 * static_cast<std::size_t>(count)) {}

  // The next index into `frame_indices` to process, or nothing if there is no more work.
  std::optional<std::size_t> start_one() {
    std::unique_lock lock(mutex);
    work_allowed.wait(lock, [this] {
      return stopping || next_to_start == frame_indices.size() ||
             next_to_start < next_to_hand_out + look_ahead;
    });
    if (stopping || next_to_start == frame_indices.size()) return std::nullopt;
    return next_to_start++;
  }

  Result<ExtractedFrame> extract(const cv::Mat& gray, FeatureExtractor& extractor) const {
    double darkest = 0;
    double brightest = 0;
    cv::minMaxLoc(gray, &darkest, &brightest);
    return ExtractedFrame{extractor.extract(gray), static_cast<int>(darkest),
                          static_cast<int>(brightest), images ? wisurf(gray) : ImageDescriptor{}};
  }

  void work() {
    FeatureExtractor extractor(parameters, camera);
    while (const auto position = start_one()) {
      const Result<cv::Mat> gray = reader.gray(frame_indices[*position]);
      Result<ExtractedFrame> frame = gray ? extract(*gray, extractor) : gray.error();
      const std::lock_guard lock(mutex);
      done.emplace(*position, std::move(frame));
      result_ready.notify_one();
    }
  }
};

FramePipeline::FramePipeline(const Drive& drive, std::vector<std::size_t> frame_indices,
                             const FeatureParameters& parameters, bool images, int threads)
    : impl_(std::make_unique<Impl>(drive, std::move(frame_indices), parameters, images, threads)) {
  for (int i = 0; i < threads; ++i) impl_->threads.emplace_back([this] { impl_->work(); });
}

FramePipeline::~FramePipeline() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->stopping = true;
  }
  impl_->work_allowed.notify_all();
  for (std::thread& thread : impl_->threads) thread.join();
}

Result<ExtractedFrame> FramePipeline::next() {
  std::unique_lock lock(impl_->mutex);
  impl_->result_ready.wait(lock, [this] { return impl_->done.contains(impl_->next_to_hand_out); });
  auto taken = impl_->done.extract(impl_->next_to_hand_out++);
  impl_->work_allowed.notify_all();
  return std::move(taken.mapped());
}

}  // namespace milepost
