#include "tests/simulator/roof.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "tests/simulator/paint.h"

namespace milepost::simulator {
namespace {

cv::Mat blank(double width_m, double height_m, int texels_per_m, const cv::Scalar& colour) {
  return {std::max(1, static_cast<int>(std::lround(height_m * texels_per_m))),
          std::max(1, static_cast<int>(std::lround(width_m * texels_per_m))), CV_8UC3, colour};
}

}  // namespace

cv::Mat paint_tiles(double width_m, double height_m, cv::RNG& random) {
  static const cv::Scalar kColours[] = {{70, 88, 168}, {62, 72, 132}, {78, 84, 96},
                                        {92, 98, 104}, {60, 80, 150}, {84, 108, 160}};
  const cv::Scalar colour = varied(kColours[random.uniform(0, 6)], 14, random);
  cv::Mat image = blank(width_m, height_m, kRoofTexelsPerM, shaded(colour, 0.7));
  constexpr int kTileWidth = 5;
  constexpr int kTileHeight = 7;
  for (int top = 0, row = 0; top < image.rows; top += kTileHeight, ++row) {
    for (int left = row % 2 == 0 ? 0 : -kTileWidth / 2; left < image.cols; left += kTileWidth) {
      cv::rectangle(image, {left, top}, {left + kTileWidth - 2, top + kTileHeight - 2},
                    varied(colour, 24, random), -1);
    }
  }
  weather(image, 4, 8, random);
  return image;
}

cv::Mat paint_flat_roof(double width_m, double height_m, cv::RNG& random) {
  const double grey = random.uniform(105.0, 165.0);
  const cv::Scalar colour = varied({grey, grey, grey}, 12, random);
  cv::Mat image = blank(width_m, height_m, kRoofTexelsPerM, colour);
  const int strip = kRoofTexelsPerM;  // bitumen comes on rolls of a metre
  for (int top = 0; top < image.rows; top += strip) {
    cv::rectangle(image, {0, top}, {image.cols, top + strip - 2}, varied(colour, 9, random), -1);
  }
  for (int puddle = 0; puddle < 4; ++puddle) {
    cv::ellipse(image, {random.uniform(0, image.cols), random.uniform(0, image.rows)},
                {random.uniform(8, 45), random.uniform(6, 30)}, random.uniform(0.0, 180.0), 0, 360,
                shaded(colour, random.uniform(0.78, 0.95)), -1, cv::LINE_AA);
  }
  weather(image, 7, 6, random);
  return image;
}

cv::Mat paint_brick(double width_m, double height_m, int texels_per_m, cv::RNG& random) {
  const cv::Scalar colour = varied({88, 104, 168}, 22, random);
  cv::Mat image = blank(width_m, height_m, texels_per_m, {150, 158, 164});
  const int brick_width = std::max(2, texels_per_m * 25 / 100);
  const int brick_height = std::max(2, texels_per_m * 8 / 100);
  for (int top = 0, row = 0; top < image.rows; top += brick_height, ++row) {
    for (int left = row % 2 == 0 ? 0 : -brick_width / 2; left < image.cols; left += brick_width) {
      cv::rectangle(image, {left, top}, {left + brick_width - 2, top + brick_height - 2},
                    varied(colour, 26, random), -1);
    }
  }
  weather(image, 4, 5, random);
  return image;
}

cv::Mat paint_metal(double width_m, double height_m, int texels_per_m, cv::RNG& random) {
  const double grey = random.uniform(95.0, 190.0);
  cv::Mat image = blank(width_m, height_m, texels_per_m, {grey, grey * 0.99, grey * 0.97});
  const int step = std::max(2, texels_per_m * random.uniform(6, 14) / 100);
  for (int top = 0; top < image.rows; top += step) {
    cv::line(image, {0, top}, {image.cols, top}, cv::Scalar::all(grey * 0.7), 1);
  }
  weather(image, 3, 5, random);
  return image;
}

cv::Mat paint_awning(double width_m, double height_m, int texels_per_m, cv::RNG& random) {
  static const cv::Scalar kCloths[] = {
      {45, 45, 165}, {70, 110, 45}, {140, 80, 40}, {50, 140, 200}, {70, 60, 75}};
  const cv::Scalar cloth = varied(kCloths[random.uniform(0, 5)], 18, random);
  cv::Mat image = blank(width_m, height_m, texels_per_m, cloth);
  const int stripe = texels_per_m * random.uniform(14, 34) / 100;
  if (random.uniform(0, 3) > 0) {
    for (int left = 0; left < image.cols; left += 2 * stripe) {
      cv::rectangle(image, {left, 0}, {left + stripe, image.rows}, {215, 222, 226}, -1);
    }
  }
  weather(image, 3, 6, random);
  return image;
}

cv::Mat paint_railing(double width_m, double height_m, int texels_per_m, cv::RNG& random) {
  const double grey = random.uniform(25.0, 75.0);
  const cv::Scalar iron(grey, grey, grey, 255);
  cv::Mat image(std::max(1, static_cast<int>(height_m * texels_per_m)),
                std::max(1, static_cast<int>(width_m * texels_per_m)), CV_8UC4,
                cv::Scalar(grey, grey, grey, 0));
  const int step = std::max(3, texels_per_m * random.uniform(9, 14) / 100);
  for (int left = 0; left < image.cols; left += step) {
    cv::rectangle(image, {left, 0}, {left + std::max(1, step / 5), image.rows}, iron, -1);
  }
  const int rail = std::max(1, texels_per_m * 5 / 100);
  cv::rectangle(image, {0, 0}, {image.cols, rail}, iron, -1);
  cv::rectangle(image, {0, image.rows - rail}, {image.cols, image.rows}, iron, -1);
  return image;
}

cv::Mat paint_board(double width_m, double height_m, int texels_per_m, cv::RNG& random) {
  static const char* const kWords[] = {"CAFE", "BAR", "OPEN", "TAXI", "INN", "DELI",
                                       "SPA",  "PUB", "ART",  "GYM",  "P",   "ZOO"};
  const cv::Scalar ground(random.uniform(20, 220), random.uniform(20, 220),
                          random.uniform(20, 220));
  cv::Mat image = blank(width_m, height_m, texels_per_m, ground);
  const bool is_dark = ground[0] + ground[1] + ground[2] < 360;
  const cv::Scalar ink = is_dark ? cv::Scalar(225, 235, 240) : cv::Scalar(30, 25, 35);
  const std::string word = kWords[random.uniform(0, 12)];
  int baseline = 0;
  const cv::Size one = cv::getTextSize(word, cv::FONT_HERSHEY_DUPLEX, 1, 2, &baseline);
  const double scale = std::min(image.cols * 0.8 / one.width, image.rows * 0.5 / one.height);
  cv::putText(image, word,
              {static_cast<int>((image.cols - one.width * scale) / 2),
               static_cast<int>((image.rows + one.height * scale) / 2)},
              cv::FONT_HERSHEY_DUPLEX, scale, ink, std::max(1, texels_per_m / 20), cv::LINE_AA);
  cv::rectangle(image, {0, 0}, {image.cols - 1, image.rows - 1}, ink,
                std::max(1, texels_per_m / 25));
  weather(image, 3, 4, random);
  return image;
}

}  // namespace milepost::simulator
