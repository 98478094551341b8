#include "mapper/aerial/stage_pictures.h"

#include <cmath>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace milepost {
namespace {

const cv::Scalar kBlue(255, 80, 0);
const cv::Scalar kRed(0, 0, 255);
const cv::Scalar kYellow(0, 255, 255);

cv::Point rounded(const Eigen::Vector2d& at) {
  return {static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y()))};
}

}  // namespace

void StagePictures::show(const std::string& name, const cv::Mat& picture) const {
  if (folder_.empty()) return;
  cv::imwrite((folder_ / (block_ + "-" + name + ".png")).string(), picture);
}

void StagePictures::show_maps(const std::string& name, const std::vector<cv::Mat>& maps) const {
  if (folder_.empty()) return;
  cv::Mat sum = cv::Mat::zeros(maps.front().size(), CV_8UC1);
  for (const cv::Mat& map : maps) sum += map / static_cast<double>(maps.size());
  show(name, sum);
}

void StagePictures::show_masks(const std::string& name, const cv::Mat& bgr, const cv::Mat& blue,
                               const cv::Mat& red) const {
  if (folder_.empty()) return;
  cv::Mat picture = bgr / 2 + cv::Scalar::all(64);
  picture.setTo(kBlue, blue);
  picture.setTo(kRed, red);
  show(name, picture);
}

void StagePictures::show_lines(const std::string& name, const Picture& picture,
                               const WallLines& lines) const {
  if (folder_.empty()) return;
  cv::Mat drawn = picture.bgr / 2 + cv::Scalar::all(64);
  for (const WallLine& line : lines) {
    const Eigen::Vector2d begin = picture.grid.pixel_from_ground(line.begin_m);
    const Eigen::Vector2d end = picture.grid.pixel_from_ground(line.end_m);
    const Eigen::Vector2d right_m = right_of(direction_of(line)) * 0.6;
    const Eigen::Vector2d middle = (begin + end) / 2;
    const Eigen::Vector2d inside =
        picture.grid.pixel_from_ground((line.begin_m + line.end_m) / 2 + right_m);
    cv::line(drawn, rounded(begin), rounded(end), kYellow, 2, cv::LINE_AA);
    cv::line(drawn, rounded(middle), rounded(inside), kRed, 1, cv::LINE_AA);
  }
  show(name, drawn);
}

void StagePictures::show_regions(const std::string& name, const cv::Mat& labels) const {
  if (folder_.empty()) return;
  cv::Mat picture(labels.size(), CV_8UC3);
  for (int y = 0; y < labels.rows; ++y) {
    for (int x = 0; x < labels.cols; ++x) {
      cv::RNG colours(static_cast<std::uint64_t>(labels.at<int>(y, x)) + 1);
      picture.at<cv::Vec3b>(y, x) = cv::Vec3b(static_cast<std::uint8_t>(colours.next()),
                                              static_cast<std::uint8_t>(colours.next()),
                                              static_cast<std::uint8_t>(colours.next()));
    }
  }
  show(name, picture);
}

void StagePictures::show_share(const std::string& name, const cv::Mat& share) const {
  if (folder_.empty()) return;
  cv::Mat picture;
  share.convertTo(picture, CV_8U, 255);
  show(name, picture);
}

}  // namespace milepost
