#include "schema/drive/image_decode.h"

#include <iostream>
#include <streambuf>
#include <utility>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "schema/drive/image_bytes.h"

namespace milepost {
namespace {

thread_local bool is_decoding = false;

// Filters std::cerr, on which OpenCV prints decoding errors: discards those and passes on the
// output of other threads. Unbuffered.
class WithoutDecoders : public std::streambuf {
 public:
  explicit WithoutDecoders(std::streambuf* to) : to_(to) {}

 protected:
  int_type overflow(int_type c) override {
    if (is_decoding || traits_type::eq_int_type(c, traits_type::eof())) {
      return traits_type::not_eof(c);
    }
    return to_->sputc(traits_type::to_char_type(c));
  }
  std::streamsize xsputn(const char* text, std::streamsize count) override {
    return is_decoding ? count : to_->sputn(text, count);
  }
  int sync() override { return is_decoding ? 0 : to_->pubsync(); }

 private:
  std::streambuf* to_;
};

class Silence {
 public:
  Silence() {
    // Never destroyed: std::cerr is used until the program ends.
    static const auto* const installed = [] {
      auto* buffer = new WithoutDecoders(std::cerr.rdbuf());
      std::cerr.rdbuf(buffer);
      return buffer;
    }();
    static_cast<void>(installed);
    is_decoding = true;
  }
  ~Silence() { is_decoding = false; }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;
};

}  // namespace

Result<cv::Mat> decoded_image(std::string bytes, int flags) {
  if (bytes.empty()) return not_decodable();
  const Result<std::string> sound = sound_image(std::move(bytes));
  if (!sound) return sound.error();
  const std::vector<unsigned char> buffer(sound->begin(), sound->end());
  const Silence silence;
  try {
    cv::Mat image = cv::imdecode(buffer, flags);
    if (!image.empty()) return image;
  } catch (const cv::Exception&) {  // for example, more pixels than the decoder allows
  }
  return not_decodable();
}

}  // namespace milepost
