#include "tests/simulator/facade.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <opencv2/imgproc.hpp>

#include "tests/simulator/paint.h"

namespace milepost::simulator {
namespace {

const cv::Scalar kWallColours[] = {{150, 190, 215}, {165, 170, 175}, {120, 165, 205},
                                   {185, 205, 215}, {110, 125, 170}, {160, 185, 170},
                                   {195, 190, 175}, {130, 150, 190}};
const cv::Scalar kTrimColours[] = {{225, 230, 232}, {190, 205, 215}, {70, 80, 90}, {120, 135, 150}};
const cv::Scalar kPaintColours[] = {{60, 90, 40}, {90, 50, 35},  {40, 45, 110},  {45, 70, 100},
                                    {50, 50, 55}, {110, 90, 40}, {40, 120, 170}, {150, 150, 150}};
const char* const kSignTexts[] = {"BAKERY", "BOOKS",  "CAFE 21", "HOTEL",   "OPTIK",  "PIZZA",
                                  "WINES",  "BANK",   "SHOES",   "FLOWERS", "RADIO",  "TAILOR",
                                  "TEA",    "MUSEUM", "TOOLS",   "KIOSK",   "TRAVEL", "PHARMACY"};

template <class T, std::size_t N>
const T& any_of(const T (&choices)[N], cv::RNG& random) {
  return choices[random.uniform(0, static_cast<int>(N))];
}

// A muted colour of any hue.
cv::Scalar any_colour(cv::RNG& random) {
  const double grey = random.uniform(40.0, 215.0);
  return {grey + random.uniform(-40, 41), grey + random.uniform(-40, 41),
          grey + random.uniform(-40, 41)};
}

// A canvas measured in metres from its top left corner.
class Canvas {
 public:
  Canvas(const WallSize& size, const cv::Scalar& colour)
      : image_(size.texels(), CV_8UC3, colour),
        width_m_(size.width_m),
        height_m_(size.height_m),
        texels_per_m_(size.texels_per_m) {}

  cv::Mat& image() { return image_; }
  double width_m() const { return width_m_; }
  double height_m() const { return height_m_; }
  int texels_per_m() const { return texels_per_m_; }

  void fill(double left_m, double top_m, double width_m, double height_m,
            const cv::Scalar& colour) {
    const cv::Point corner(place(left_m), place(top_m));
    const cv::Point end(place(left_m + width_m) - 1, place(top_m + height_m) - 1);
    if (end.x >= corner.x && end.y >= corner.y) cv::rectangle(image_, corner, end, colour, -1);
  }
  void disc(double x_m, double y_m, double radius_m, const cv::Scalar& colour) {
    cv::circle(image_, {place(x_m), place(y_m)}, place(radius_m), colour, -1, cv::LINE_AA);
  }
  void line(cv::Point2d from_m, cv::Point2d to_m, double width_m, const cv::Scalar& colour) {
    cv::line(image_, {place(from_m.x), place(from_m.y)}, {place(to_m.x), place(to_m.y)}, colour,
             std::max(1, place(width_m)), cv::LINE_AA);
  }
  // Text that fills the given box from its left.
  void write(const std::string& text, double left_m, double base_m, double width_m, double height_m,
             const cv::Scalar& colour) {
    const int thickness = std::max(1, place(height_m * 0.16));
    int baseline = 0;
    const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_DUPLEX, 1, 1, &baseline);
    const double scale = std::min(place(width_m) / static_cast<double>(size.width),
                                  place(height_m) / static_cast<double>(size.height));
    cv::putText(image_, text, {place(left_m), place(base_m)}, cv::FONT_HERSHEY_DUPLEX, scale,
                colour, thickness, cv::LINE_AA);
  }

 private:
  int place(double metres) const { return static_cast<int>(std::lround(metres * texels_per_m_)); }

  cv::Mat image_;
  double width_m_;
  double height_m_;
  int texels_per_m_;
};

// Blocks in courses, every second course shifted by half a block.
void paint_blocks(Canvas& canvas, double block_width_m, double block_height_m,
                  const cv::Scalar& colour, double spread, cv::RNG& random) {
  constexpr double kJointM = 0.02;
  canvas.fill(0, 0, canvas.width_m(), canvas.height_m(), shaded(colour, 0.75));
  bool shifted = false;
  for (double top = 0; top < canvas.height_m(); top += block_height_m, shifted = !shifted) {
    for (double left = shifted ? -block_width_m / 2 : 0; left < canvas.width_m();
         left += block_width_m) {
      canvas.fill(left, top, block_width_m - kJointM, block_height_m - kJointM,
                  varied(colour, spread, random));
    }
  }
}

void paint_wall(Canvas& canvas, const cv::Scalar& colour, cv::RNG& random) {
  switch (random.uniform(0, 3)) {
    case 0:
      paint_blocks(canvas, 0.36, 0.14, colour, 22, random);
      break;
    case 1:
      paint_blocks(canvas, 0.9, 0.45, colour, 14, random);
      break;
    default:
      break;  // plaster
  }
  weather(canvas.image(), 5, 7, random);
}

// The view behind a pane: the dark room, the sky's reflection, and often a curtain.
void paint_glass(Canvas& canvas, double left, double top, double width, double height,
                 cv::RNG& random) {
  const cv::Scalar dark = varied({70, 60, 50}, 25, random);
  const int bands = 6;
  for (int band = 0; band < bands; ++band) {
    canvas.fill(left, top + height * band / bands, width, height / bands + 0.02,
                shaded(dark, 1.6 - 0.8 * band / bands));
  }
  const cv::Scalar cloth = varied({205, 215, 220}, 30, random);
  switch (random.uniform(0, 5)) {
    case 0:  // curtains drawn aside
      canvas.fill(left, top, width * random.uniform(0.15, 0.4), height, cloth);
      canvas.fill(left + width * random.uniform(0.6, 0.85), top, width * 0.15, height, cloth);
      break;
    case 1:  // a blind, partly down
      for (double y = 0; y < height * random.uniform(0.2, 0.9); y += 0.1) {
        canvas.fill(left, top + y, width, 0.07, cloth);
      }
      break;
    case 2:  // a plant on the sill
      for (int leaf = 0; leaf < 12; ++leaf) {
        canvas.disc(left + width * random.uniform(0.2, 0.8),
                    top + height * random.uniform(0.6, 0.95), random.uniform(0.03, 0.1),
                    varied({50, 120, 60}, 40, random));
      }
      break;
    case 3:  // a lamp
      canvas.disc(left + width * random.uniform(0.3, 0.7), top + height * random.uniform(0.2, 0.5),
                  random.uniform(0.06, 0.14), {150, 220, 250});
      break;
    default:
      break;
  }
}

struct WindowStyle {
  double width_m, height_m;
  cv::Scalar trim, frame;
  int panes;  // side by side
  bool has_bar, has_shutters;
};

WindowStyle any_window_style(cv::RNG& random) {
  WindowStyle style;
  style.width_m = random.uniform(0.9, 1.5);
  style.height_m = random.uniform(1.3, 1.9);
  style.trim = any_of(kTrimColours, random);
  style.frame =
      random.uniform(0, 2) == 0 ? cv::Scalar(235, 238, 240) : any_of(kPaintColours, random);
  style.panes = random.uniform(1, 4);
  style.has_bar = random.uniform(0, 2) == 0;
  style.has_shutters = random.uniform(0, 3) == 0;
  return style;
}

void paint_shutters(Canvas& canvas, double left, double top, const WindowStyle& style,
                    cv::RNG& random) {
  const double width = style.width_m * 0.42;
  const cv::Scalar colour = varied(style.frame * 0.7, 12, random);
  for (const double x : {left - width - 0.06, left + style.width_m + 0.06}) {
    canvas.fill(x, top, width, style.height_m, colour);
    for (double y = 0.08; y < style.height_m - 0.1; y += 0.11) {
      canvas.fill(x + 0.05, top + y, width - 0.1, 0.05, shaded(colour, 0.65));
    }
  }
}

void paint_flower_box(Canvas& canvas, double left, double sill, double width, cv::RNG& random) {
  canvas.fill(left, sill - 0.18, width, 0.2, varied({50, 70, 110}, 15, random));
  const cv::Scalar blossom = varied({90, 70, 210}, 60, random);
  for (int i = 0; i < 26; ++i) {
    const cv::Scalar colour = i % 2 == 0 ? varied({50, 130, 60}, 30, random) : blossom;
    canvas.disc(left + random.uniform(0.0, width), sill - random.uniform(0.15, 0.38),
                random.uniform(0.03, 0.07), colour);
  }
}

void paint_window(Canvas& canvas, double left, double top, const WindowStyle& style,
                  cv::RNG& random) {
  constexpr double kTrimM = 0.12;
  constexpr double kFrameM = 0.06;
  const double width = style.width_m;
  const double height = style.height_m;
  if (style.has_shutters) paint_shutters(canvas, left, top, style, random);
  canvas.fill(left - kTrimM, top - kTrimM, width + 2 * kTrimM, height + 2 * kTrimM, style.trim);
  canvas.fill(left, top, width, height, style.frame);
  const double pane = (width - kFrameM) / style.panes;
  for (int i = 0; i < style.panes; ++i) {
    paint_glass(canvas, left + kFrameM + i * pane, top + kFrameM, pane - kFrameM,
                height - 2 * kFrameM, random);
  }
  if (style.has_bar) canvas.fill(left, top + height * 0.3, width, kFrameM, style.frame);
  canvas.fill(left, top, width, 0.05, shaded(style.trim, 0.4));  // the lintel's shadow
  canvas.fill(left - 0.2, top + height + 0.08, width + 0.4, 0.1, shaded(style.trim, 0.9));
  canvas.fill(left - 0.2, top + height + 0.18, width + 0.4, 0.05, shaded(style.trim, 0.4));
  if (random.uniform(0, 4) == 0) {
    paint_flower_box(canvas, left, top + height + 0.1, width, random);
  }
}

void paint_door(Canvas& canvas, double left, double width, cv::RNG& random) {
  const double height = random.uniform(2.2, 2.7);
  const double top = canvas.height_m() - height;
  const cv::Scalar trim = any_of(kTrimColours, random);
  const cv::Scalar colour = varied(any_of(kPaintColours, random), 10, random);
  canvas.fill(left - 0.15, top - 0.15, width + 0.3, height + 0.15, trim);
  canvas.fill(left, top, width, height, colour);
  paint_glass(canvas, left + 0.08, top + 0.08, width - 0.16, 0.35, random);
  for (double y = 0.6; y < height - 0.5; y += 0.65) {
    for (const double x : {0.1, width / 2 + 0.05}) {
      canvas.fill(left + x, top + y, width / 2 - 0.15, 0.5, shaded(colour, 1.3));
      canvas.fill(left + x + 0.04, top + y + 0.04, width / 2 - 0.23, 0.42, shaded(colour, 0.8));
    }
  }
  canvas.disc(left + width - 0.12, top + height * 0.55, 0.04, {90, 190, 210});
  canvas.fill(left + width + 0.25, top + 0.5, 0.3, 0.22, {120, 50, 30});
  canvas.write(std::to_string(random.uniform(1, 99)), left + width + 0.28, top + 0.68, 0.24, 0.14,
               {240, 240, 240});
}

void paint_shop(Canvas& canvas, double left, double width, cv::RNG& random) {
  const double bottom = canvas.height_m() - 0.5;
  const double top = canvas.height_m() - 2.7;
  const cv::Scalar colour = varied(any_of(kPaintColours, random), 15, random);
  canvas.fill(left - 0.1, top - 0.9, width + 0.2, bottom - top + 1.0, colour);
  canvas.fill(left, top, width, bottom - top, {60, 52, 48});
  for (int item = 0; item < static_cast<int>(width * 9); ++item) {  // the goods on show
    const double w = random.uniform(0.1, 0.45);
    const double h = random.uniform(0.1, 0.6);
    const cv::Scalar any = any_colour(random);
    canvas.fill(left + random.uniform(0.0, std::max(0.01, width - w)),
                top + 0.4 + random.uniform(0.0, bottom - top - 0.5 - h), w, h, any);
  }
  for (double x = 0; x < width; x += width / 2.01) {
    canvas.fill(left + x, top, 0.07, bottom - top, shaded(colour, 1.4));
  }
  const cv::Scalar letters =
      cv::mean(colour)[0] > 90 ? cv::Scalar(30, 30, 40) : cv::Scalar(200, 235, 240);
  canvas.write(any_of(kSignTexts, random), left + 0.25, top - 0.22, width - 0.5, 0.45, letters);
}

void paint_posters(Canvas& canvas, double left, double width, cv::RNG& random) {
  const int count = random.uniform(1, 4);
  for (int i = 0; i < count; ++i) {
    const double w = random.uniform(0.4, 0.8);
    const double x = left + random.uniform(0.0, std::max(0.01, width - w));
    const double y = canvas.height_m() - random.uniform(1.6, 2.3);
    canvas.fill(x, y, w, w * 1.4, varied({200, 210, 215}, 40, random));
    for (int mark = 0; mark < 6; ++mark) {
      const cv::Scalar any = any_colour(random);
      canvas.fill(x + 0.05 + random.uniform(0.0, w * 0.4), y + random.uniform(0.05, w * 1.2),
                  random.uniform(0.1, w * 0.45), random.uniform(0.03, 0.15), any);
    }
  }
}

// One stretch of the ground floor: a door, a shop or a window with posters beside.
void paint_ground_floor_bay(Canvas& canvas, double left, double width, const WindowStyle& style,
                            bool has_shops, cv::RNG& random) {
  switch (random.uniform(0, has_shops ? 4 : 2)) {
    case 0:
      paint_door(canvas, left + width / 2 - 0.55, 1.1, random);
      break;
    case 2:
    case 3:
      paint_shop(canvas, left + 0.2, width - 0.4, random);
      break;
    default:
      if (has_shops) paint_posters(canvas, left, width, random);
      paint_window(canvas, left + (width - style.width_m) / 2, canvas.height_m() - 2.6, style,
                   random);
      break;
  }
}

void paint_drainpipe(Canvas& canvas, double left, cv::RNG& random) {
  const cv::Scalar colour = varied({110, 115, 115}, 25, random);
  canvas.fill(left, 0, 0.12, canvas.height_m(), colour);
  canvas.fill(left + 0.08, 0, 0.04, canvas.height_m(), shaded(colour, 0.6));
  for (double y = random.uniform(0.5, 1.5); y < canvas.height_m(); y += 2.1) {
    canvas.fill(left - 0.03, y, 0.18, 0.08, shaded(colour, 0.5));
  }
}

// A line of moulding with its shadow.
void paint_moulding(Canvas& canvas, double top, double height, const cv::Scalar& colour) {
  canvas.fill(0, top, canvas.width_m(), height, colour);
  canvas.fill(0, top + height, canvas.width_m(), height * 0.5, shaded(colour, 0.45));
}

void paint_upper_floors(Canvas& canvas, double ground_floor_m, double floor_m, int columns,
                        const WindowStyle& style, cv::RNG& random) {
  const double bay = canvas.width_m() / columns;
  for (double base = canvas.height_m() - ground_floor_m; base - floor_m > 0.1; base -= floor_m) {
    for (int column = 0; column < columns; ++column) {
      paint_window(canvas, bay * (column + 0.5) - style.width_m / 2, base - 0.85 - style.height_m,
                   style, random);
    }
    paint_moulding(canvas, base - 0.1, 0.14, style.trim);
  }
}

// Rain streaks below sills, and soot near the ground.
void paint_dirt(Canvas& canvas, cv::RNG& random) {
  cv::Mat& image = canvas.image();
  const int per_m = canvas.texels_per_m();
  cv::Mat dirt(image.size(), CV_8UC3, cv::Scalar::all(255));
  for (int streak = 0; streak < static_cast<int>(canvas.width_m() * 4); ++streak) {
    const int x = random.uniform(0, image.cols);
    const int y = random.uniform(0, image.rows);
    const int length = static_cast<int>(random.uniform(0.3, 2.4) * per_m);
    const int lean = static_cast<int>(random.uniform(-0.07, 0.07) * per_m);
    const int width = std::max(1, static_cast<int>(random.uniform(0.03, 0.14) * per_m));
    cv::line(dirt, {x, y}, {x + lean, y + length}, cv::Scalar::all(random.uniform(185, 245)),
             width);
  }
  cv::GaussianBlur(dirt, dirt, {}, std::max(0.5, per_m * 0.05));
  cv::multiply(image, dirt, image, 1.0 / 255);
  const int soot = std::min(image.rows, per_m);
  for (int row = 0; row < soot; ++row) {
    cv::Mat line = image.row(image.rows - soot + row);
    line *= 1.0 - 0.3 * row / soot;
  }
}

// A painted advertisement on a firewall.
void paint_advertisement(Canvas& canvas, double left, double top, double width, double height,
                         cv::RNG& random) {
  canvas.fill(left - 0.08, top - 0.08, width + 0.16, height + 0.16, {60, 62, 64});
  canvas.fill(left, top, width, height, any_colour(random));
  for (int shape = 0; shape < 7; ++shape) {
    const cv::Scalar colour = any_colour(random);
    const double x = left + width * random.uniform(0.1, 0.9);
    const double y = top + height * random.uniform(0.15, 0.7);
    const double room = std::min({x - left, left + width - x, y - top, top + height - y});
    canvas.disc(x, y, room * random.uniform(0.3, 0.95), colour);
  }
  canvas.fill(left, top + height * 0.72, width, height * 0.28, {222, 226, 228});
  canvas.write(any_of(kSignTexts, random), left + width * 0.08, top + height * 0.94, width * 0.8,
               height * 0.18, any_of(kPaintColours, random));
}

}  // namespace

cv::Mat paint_facade(const WallSize& size, bool has_shops, cv::RNG& random) {
  const auto [width_m, height_m, texels_per_m] = size;
  const cv::Scalar colour = varied(any_of(kWallColours, random), 18, random);
  Canvas canvas(size, colour);
  paint_wall(canvas, colour, random);
  const WindowStyle style = any_window_style(random);
  const double floor_m = random.uniform(2.9, 3.4);
  const double bay_m = random.uniform(2.4, 3.2) + (style.has_shutters ? 0.7 : 0);
  const int columns = std::max(1, static_cast<int>(width_m / bay_m));
  canvas.fill(0, height_m - 0.7, width_m, 0.7, varied({105, 110, 115}, 20, random));
  paint_upper_floors(canvas, 3.6, floor_m, columns, style, random);
  const int bays = std::max(1, static_cast<int>(width_m / 3.4));
  for (int bay = 0; bay < bays; ++bay) {
    paint_ground_floor_bay(canvas, width_m * bay / bays, width_m / bays, style, has_shops, random);
  }
  paint_drainpipe(canvas, random.uniform(0, 2) == 0 ? 0.1 : width_m - 0.3, random);
  paint_moulding(canvas, 0, 0.35, style.trim);
  paint_dirt(canvas, random);
  weather(canvas.image(), 3, 2, random);
  return canvas.image();
}

cv::Mat paint_oriel(const WallSize& size, cv::RNG& random) {
  const cv::Scalar colour = varied(any_of(kWallColours, random), 18, random);
  Canvas canvas(size, colour);
  paint_wall(canvas, colour, random);
  WindowStyle style = any_window_style(random);
  style.has_shutters = false;
  const int columns = std::max(1, static_cast<int>(size.width_m / 1.9));
  paint_upper_floors(canvas, 0, 3.1, columns, style, random);
  paint_dirt(canvas, random);
  return canvas.image();
}

cv::Mat paint_side_wall(const WallSize& size, cv::RNG& random) {
  const auto [width_m, height_m, texels_per_m] = size;
  const cv::Scalar colour = varied(any_of(kWallColours, random), 18, random);
  Canvas canvas(size, colour);
  paint_wall(canvas, colour, random);
  const WindowStyle style = any_window_style(random);
  const int columns = static_cast<int>(width_m / 2.7);
  for (double base = height_m - 0.6; base > 3; base -= 3.1) {
    for (int column = 0; column < columns; ++column) {
      if (random.uniform(0, 5) < 2) continue;
      paint_window(canvas, width_m * (column + 0.5) / columns - style.width_m / 2,
                   base - 0.6 - style.height_m, style, random);
    }
  }
  if (width_m > 6 && height_m > 7 && random.uniform(0, 4) == 0) {
    const double wide_m = random.uniform(2.6, 4.2);
    paint_advertisement(canvas, random.uniform(0.6, width_m - wide_m - 0.6),
                        height_m - random.uniform(4.6, 6.2), wide_m, wide_m * 0.75, random);
  }
  if (random.uniform(0, 2) == 0) paint_drainpipe(canvas, width_m - 0.4, random);
  paint_dirt(canvas, random);
  return canvas.image();
}

cv::Mat paint_garden_wall(const WallSize& size, cv::RNG& random) {
  const auto [width_m, height_m, texels_per_m] = size;
  Canvas canvas(size, {0, 0, 0});
  paint_blocks(canvas, 0.5, 0.22, varied({115, 135, 165}, 30, random), 30, random);
  canvas.fill(0, 0, width_m, 0.14, {160, 165, 165});
  if (random.uniform(0, 2) == 0) paint_posters(canvas, 0, width_m, random);
  weather(canvas.image(), 5, 8, random);
  paint_dirt(canvas, random);
  return canvas.image();
}

cv::Mat paint_traffic_sign(double side_m, cv::RNG& random) {
  Canvas canvas({side_m, side_m, kNearTexelsPerM}, {225, 228, 228});
  const double middle = side_m / 2;
  const cv::Scalar rim =
      random.uniform(0, 2) == 0 ? cv::Scalar(40, 30, 190) : cv::Scalar(160, 80, 20);
  canvas.disc(middle, middle, side_m * 0.47, rim);
  canvas.disc(middle, middle, side_m * 0.36, {230, 232, 232});
  canvas.write(std::to_string(random.uniform(2, 9) * 10), side_m * 0.27, side_m * 0.62,
               side_m * 0.5, side_m * 0.26, {25, 25, 25});
  return canvas.image();
}

cv::Mat paint_pole(const WallSize& size, cv::RNG& random) {
  const auto [width_m, height_m, texels_per_m] = size;
  Canvas canvas(size, varied({105, 110, 105}, 25, random));
  for (int sticker = 0; sticker < 3; ++sticker) {
    const double y = height_m - random.uniform(0.6, std::min(2.2, height_m));
    const cv::Scalar any = any_colour(random);
    canvas.fill(0.02, y, width_m - 0.04, random.uniform(0.08, 0.2), any);
  }
  weather(canvas.image(), 4, 5, random);
  return canvas.image();
}

}  // namespace milepost::simulator
