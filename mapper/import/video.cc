#include "mapper/import/video.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libavutil/log.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "mapper/import/image_times.h"
#include "schema/base/digits.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;

struct CloseFfmpeg {
  void operator()(AVFormatContext* context) const { avformat_close_input(&context); }
  void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(SwsContext* context) const { sws_freeContext(context); }
};
template <class Object>
using Owned = std::unique_ptr<Object, CloseFfmpeg>;

std::string message_of(int error) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  return av_make_error_string(text.data(), text.size(), error);
}

Error wrong(const fs::path& file, const std::string& what) {
  return {ErrorCode::invalid_input, file.string(), what, "name a video that FFmpeg can play"};
}

// An open file, and the stream of its video.
struct Opened {
  Owned<AVFormatContext> format;
  AVStream* stream = nullptr;
};

Result<Opened> open_file(const fs::path& file) {
  av_log_set_level(AV_LOG_QUIET);
  AVFormatContext* raw = nullptr;
  if (const int error = avformat_open_input(&raw, file.c_str(), nullptr, nullptr); error < 0)
    return wrong(file, "is no video (" + message_of(error) + ")");
  Opened opened{Owned<AVFormatContext>(raw)};
  if (const int error = avformat_find_stream_info(raw, nullptr); error < 0)
    return wrong(file, "is no video (" + message_of(error) + ")");
  const int index = av_find_best_stream(raw, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (index < 0) return wrong(file, "holds no video");
  opened.stream = raw->streams[index];
  return opened;
}

// By how many quarters to the right a player turns the frames.
int quarters_of(const AVStream& stream) {
  const auto* matrix = reinterpret_cast<const std::int32_t*>(
      av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr));
  if (matrix == nullptr) return 0;
  const double to_the_left_deg = av_display_rotation_get(matrix);
  if (std::isnan(to_the_left_deg)) return 0;
  return (static_cast<int>(std::lround(-to_the_left_deg / 90)) % 4 + 4) % 4;
}

// When the video was taken; nothing if it does not tell.
std::optional<double> created_s(const Opened& opened) {
  for (const AVDictionary* texts : {opened.format->metadata, opened.stream->metadata}) {
    const AVDictionaryEntry* entry = av_dict_get(texts, "creation_time", nullptr, 0);
    if (entry != nullptr) {
      if (const auto seconds = seconds_of_date(entry->value)) return seconds;
    }
  }
  return std::nullopt;
}

class VideoFrames : public ImageContainer {
 public:
  // `stamps`: of all frames, in the units of the stream, ascending.
  VideoFrames(fs::path file, Opened opened, Owned<AVCodecContext> decoder,
              std::vector<std::int64_t> stamps)
      : file_(std::move(file)),
        opened_(std::move(opened)),
        decoder_(std::move(decoder)),
        stamps_(std::move(stamps)),
        quarters_(quarters_of(*opened_.stream)) {}

  Status write(const RecordedImage& image, const fs::path& to) override {
    const std::int64_t wanted = stamps_[image.entry];
    while (!has_frame_ || frame_->best_effort_timestamp < wanted) {
      const Result<bool> next = decode_next();
      if (!next) return next.error();
      if (!*next) break;
    }
    if (!has_frame_ || frame_->best_effort_timestamp != wanted) {
      return Error{ErrorCode::corrupt, file_.string(),
                   "its frame at " + fixed(seconds(wanted), 3) + " s cannot be decoded",
                   "repair the video, or cut it there"};
    }
    return write_frame(to);
  }

 private:
  double seconds(std::int64_t stamp) const {
    return static_cast<double>(stamp) * av_q2d(opened_.stream->time_base);
  }

  // False at the end.
  Result<bool> decode_next() {
    while (true) {
      const int received = avcodec_receive_frame(decoder_.get(), frame_.get());
      if (received == 0) {
        has_frame_ = true;
        return true;
      }
      if (received == AVERROR_EOF) return has_frame_ = false;
      if (received != AVERROR(EAGAIN)) return failed(received);
      if (const Status fed = feed(); !fed) return fed.error();
    }
  }

  // Gives the decoder the next packet, or tells it that there is none.
  Status feed() {
    int read = 0;
    do {
      av_packet_unref(packet_.get());
      read = av_read_frame(opened_.format.get(), packet_.get());
    } while (read == 0 && packet_->stream_index != opened_.stream->index);
    // A packet that the decoder refuses is damaged: the frames after it may be sound.
    avcodec_send_packet(decoder_.get(), read == 0 ? packet_.get() : nullptr);
    return read == 0 || read == AVERROR_EOF ? ok_status() : Status(failed(read));
  }

  Status write_frame(const fs::path& to) {
    cv::Mat image(frame_->height, frame_->width, CV_8UC3);
    scaler_.reset(sws_getCachedContext(scaler_.release(), frame_->width, frame_->height,
                                       static_cast<AVPixelFormat>(frame_->format), frame_->width,
                                       frame_->height, AV_PIX_FMT_BGR24,
                                       SWS_BICUBIC | SWS_ACCURATE_RND, nullptr, nullptr, nullptr));
    if (!scaler_) return wrong(file_, "its pixels are of a kind that is not known");
    std::uint8_t* const rows[] = {image.data};
    const int strides[] = {static_cast<int>(image.step)};
    sws_scale(scaler_.get(), frame_->data, frame_->linesize, 0, frame_->height, rows, strides);
    constexpr std::array<cv::RotateFlags, 3> kTurns = {cv::ROTATE_90_CLOCKWISE, cv::ROTATE_180,
                                                       cv::ROTATE_90_COUNTERCLOCKWISE};
    if (quarters_ > 0) cv::rotate(image, image, kTurns.at(static_cast<std::size_t>(quarters_ - 1)));
    constexpr int kQuality = 95;
    if (cv::imwrite(to.string(), image, {cv::IMWRITE_JPEG_QUALITY, kQuality})) return ok_status();
    return Error{ErrorCode::io, to.string(), "cannot be written",
                 "check the free space and the permissions"};
  }

  Error failed(int error) const {
    return {ErrorCode::corrupt, file_.string(), "cannot be decoded (" + message_of(error) + ")",
            "repair the video, or cut it"};
  }

  fs::path file_;
  Opened opened_;
  Owned<AVCodecContext> decoder_;
  std::vector<std::int64_t> stamps_;
  int quarters_;
  Owned<AVPacket> packet_{av_packet_alloc()};
  Owned<AVFrame> frame_{av_frame_alloc()};
  bool has_frame_ = false;
  Owned<SwsContext> scaler_;
};

// The times of all frames, in the units of the stream, ascending; nothing is decoded.
Result<std::vector<std::int64_t>> stamps_in(const fs::path& file) {
  Result<Opened> opened = open_file(file);
  if (!opened) return opened.error();
  const Owned<AVPacket> packet(av_packet_alloc());
  std::vector<std::int64_t> stamps;
  while (av_read_frame(opened->format.get(), packet.get()) == 0) {
    const bool is_frame =
        packet->stream_index == opened->stream->index && (packet->flags & AV_PKT_FLAG_DISCARD) == 0;
    const std::int64_t stamp = packet->pts == AV_NOPTS_VALUE ? packet->dts : packet->pts;
    if (is_frame && stamp != AV_NOPTS_VALUE) stamps.push_back(stamp);
    av_packet_unref(packet.get());
  }
  std::ranges::sort(stamps);
  stamps.erase(std::unique(stamps.begin(), stamps.end()), stamps.end());
  if (stamps.empty()) return wrong(file, "holds no frame with a time");
  return stamps;
}

}  // namespace

Result<Video> open_video(const fs::path& file, double rate_hz) {
  auto stamps = stamps_in(file);
  if (!stamps) return stamps.error();
  Result<Opened> opened = open_file(file);
  if (!opened) return opened.error();
  const AVCodecParameters& parameters = *opened->stream->codecpar;
  const AVCodec* codec = avcodec_find_decoder(parameters.codec_id);
  Owned<AVCodecContext> decoder(codec == nullptr ? nullptr : avcodec_alloc_context3(codec));
  const bool is_ready = decoder && avcodec_parameters_to_context(decoder.get(), &parameters) >= 0 &&
                        avcodec_open2(decoder.get(), codec, nullptr) >= 0;
  if (!is_ready) return wrong(file, "is coded as nothing here can decode");
  const double unit_s = av_q2d(opened->stream->time_base);
  const double begin_s = created_s(*opened).value_or(0);
  Video video;
  double slot = -1;
  for (std::size_t i = 0; i < stamps->size(); ++i) {
    const double time_s = static_cast<double>((*stamps)[i] - stamps->front()) * unit_s;
    // The first frame of each interval; times are rounded to the stream's units.
    const double its_slot = std::floor(time_s * rate_hz + 0.01);
    if (rate_hz > 0 && its_slot == slot) continue;
    slot = its_slot;
    std::string number = std::to_string(i);
    number.insert(0, 6 - std::min<std::size_t>(6, number.size()), '0');
    video.images.push_back({number + ".jpg", begin_s + time_s, i});
  }
  video.frames = std::make_shared<VideoFrames>(file, std::move(*opened), std::move(decoder),
                                               std::move(*stamps));
  return video;
}

}  // namespace milepost
