#include "tests/simulator/vehicle.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "tests/simulator/paint.h"
#include "tests/simulator/solids.h"

namespace milepost::simulator {
namespace {

constexpr int kTexelsPerM = 96;

// A point on a vehicle's side, in metres: from its front, and above the ground.
struct Side {
  double back_m, up_m;
};

// The outline of a vehicle's side from the foot of its front over its roof to the foot of its back,
// and which stretches of it are glass.
struct Shape {
  double width_m;
  std::vector<Side> outline;
  std::vector<bool> is_glass;    // of the stretch that begins at each point
  std::vector<double> wheels_m;  // from the front
  double wheel_radius_m;
  std::vector<std::vector<Side>> windows;

  double length_m() const {
    double longest = 0;
    for (const Side& side : outline) longest = std::max(longest, side.back_m);
    return longest;
  }
  double height_m() const {
    double highest = 0;
    for (const Side& side : outline) highest = std::max(highest, side.up_m);
    return highest;
  }
};

const Shape& shape_of(VehicleKind kind) {
  static const Shape hatchback{
      1.76,
      {{0, 0.3}, {0, 0.72}, {0.95, 0.95}, {1.75, 1.46}, {3.35, 1.5}, {4.0, 1.0}, {4.05, 0.3}},
      {false, false, true, false, true, false, false},
      {0.78, 3.3},
      0.31,
      {{{1.2, 1.0}, {1.82, 1.38}, {2.45, 1.4}, {2.45, 1.0}},
       {{2.53, 1.0}, {2.53, 1.4}, {3.3, 1.4}, {3.65, 1.02}}}};
  static const Shape saloon{1.82,
                            {{0, 0.3},
                             {0, 0.7},
                             {1.2, 0.92},
                             {1.95, 1.42},
                             {3.3, 1.44},
                             {3.95, 1.04},
                             {4.6, 0.98},
                             {4.65, 0.3}},
                            {false, false, true, false, true, false, false, false},
                            {0.85, 3.7},
                            0.33,
                            {{{1.45, 0.98}, {2.0, 1.34}, {2.7, 1.36}, {2.7, 0.98}},
                             {{2.78, 0.98}, {2.78, 1.36}, {3.25, 1.36}, {3.75, 1.0}}}};
  static const Shape van{
      1.98,
      {{0, 0.35}, {0, 1.0}, {0.6, 1.25}, {1.25, 2.1}, {1.6, 2.3}, {5.2, 2.3}, {5.3, 0.35}},
      {false, false, true, false, false, false, false},
      {0.9, 4.2},
      0.35,
      {{{0.95, 1.3}, {1.4, 1.95}, {2.1, 1.95}, {2.1, 1.3}}}};
  static const Shape truck{
      2.48,
      {{0, 0.45}, {0, 1.5}, {0.15, 2.7}, {1.9, 2.8}, {1.95, 3.5}, {8.2, 3.5}, {8.2, 0.9}},
      {false, true, false, false, false, false, false},
      {1.2, 6.2, 7.1},
      0.48,
      {{{0.45, 1.6}, {0.5, 2.4}, {1.4, 2.4}, {1.4, 1.6}}}};
  switch (kind) {
    case VehicleKind::hatchback:
      return hatchback;
    case VehicleKind::saloon:
      return saloon;
    case VehicleKind::van:
      return van;
    case VehicleKind::truck:
      break;
  }
  return truck;
}

cv::Scalar any_body_colour(cv::RNG& random) {
  static const cv::Scalar kColours[] = {{210, 212, 214}, {235, 236, 236}, {48, 46, 45},
                                        {120, 118, 115}, {95, 55, 30},    {40, 38, 150},
                                        {60, 95, 50},    {150, 140, 128}, {60, 130, 190},
                                        {110, 105, 60},  {165, 168, 170}};
  return varied(kColours[random.uniform(0, 11)], 10, random);
}

int texels(double metres) { return static_cast<int>(std::lround(metres * kTexelsPerM)); }

void fill(cv::Mat& image, const std::vector<Side>& places, double height_m,
          const cv::Scalar& colour) {
  std::vector<cv::Point> points;
  for (const Side& place : places) {
    points.emplace_back(texels(place.back_m), texels(height_m - place.up_m));
  }
  cv::fillPoly(image, std::vector<std::vector<cv::Point>>{points}, colour, cv::LINE_8);
}

cv::Scalar opaque(const cv::Scalar& colour) { return {colour[0], colour[1], colour[2], 255}; }

const char* const kFirms[] = {"NORDIC FREIGHT", "BLITZ",   "ROSSI & SONS", "AQUA",
                              "VITA FOODS",     "EXPRESS", "KRAMER BAU",   "FIORE"};

// The lettering on the flank of a van or truck.
void paint_livery(cv::Mat& image, const Shape& shape, double from_m, cv::RNG& random) {
  const std::string word = kFirms[random.uniform(0, 8)];
  const cv::Scalar ink = opaque(varied(
      {random.uniform(20.0, 170.0), random.uniform(20.0, 120.0), random.uniform(20.0, 190.0)}, 10,
      random));
  const double room_m = shape.length_m() - from_m - 0.6;
  int baseline = 0;
  const cv::Size one = cv::getTextSize(word, cv::FONT_HERSHEY_DUPLEX, 1, 2, &baseline);
  const double scale = std::min(texels(room_m) / static_cast<double>(one.width), 3.2);
  const int top = texels(shape.height_m() * 0.42);
  cv::putText(image, word, {texels(from_m + 0.3), top}, cv::FONT_HERSHEY_DUPLEX, scale, ink,
              std::max(2, static_cast<int>(scale * 2.5)), cv::LINE_8);
  cv::rectangle(image, {texels(from_m + 0.3), top + 14}, {texels(from_m + room_m), top + 26}, ink,
                -1);
}

cv::Mat paint_side(VehicleKind kind, const cv::Scalar& body, cv::RNG& random) {
  const Shape& shape = shape_of(kind);
  const double height = shape.height_m();
  cv::Mat image(texels(height), texels(shape.length_m()), CV_8UC4,
                cv::Scalar(body[0] * 0.6, body[1] * 0.6, body[2] * 0.6, 0));
  fill(image, shape.outline, height, opaque(body));
  // Rounded flanks: lighter below the windows, darker towards the sill.
  for (int row = 0; row < image.rows; ++row) {
    const double up = height - static_cast<double>(row) / kTexelsPerM;
    const double shade = 0.72 + 0.38 * std::clamp(up / 1.1, 0.0, 1.0);
    for (int column = 0; column < image.cols; ++column) {
      auto& texel = image.at<cv::Vec4b>(row, column);
      for (int i = 0; i < 3; ++i) texel[i] = cv::saturate_cast<uchar>(texel[i] * shade);
    }
  }
  if (kind == VehicleKind::van) paint_livery(image, shape, 2.2, random);
  if (kind == VehicleKind::truck) paint_livery(image, shape, 2.1, random);
  for (const auto& window : shape.windows) {
    fill(image, window, height, {52, 46, 42, 255});
    std::vector<Side> gleam = window;
    for (Side& place : gleam) place.up_m -= 0.16;
    gleam[0] = window[0];
    gleam.back() = window.back();
    fill(image, gleam, height, {88, 78, 70, 255});
  }
  const cv::Scalar seam = opaque(body * 0.45);
  if (kind == VehicleKind::hatchback || kind == VehicleKind::saloon) {
    const double front = shape.windows[0][0].back_m;
    for (const double at :
         {front + 0.1, shape.windows[1][0].back_m - 0.04, shape.windows[1].back().back_m - 0.1}) {
      cv::line(image, {texels(at), texels(height - 1.0)}, {texels(at), texels(height - 0.34)}, seam,
               2);
    }
    for (const double at : {front + 0.95, front + 1.9}) {
      cv::rectangle(image, {texels(at), texels(height - 0.88)},
                    {texels(at + 0.2), texels(height - 0.84)}, {40, 40, 40, 255}, -1);
    }
    cv::line(image, {texels(0.15), texels(height - 0.62)}, {image.cols - 16, texels(height - 0.66)},
             opaque(body * 0.8), 2);
  }
  cv::rectangle(image, {texels(0.0), texels(height - 0.68)}, {texels(0.22), texels(height - 0.56)},
                {220, 230, 235, 255}, -1);
  cv::rectangle(image, {image.cols - texels(0.18), texels(height - 0.85)},
                {image.cols, texels(height - 0.66)}, {40, 30, 170, 255}, -1);
  for (const double wheel : shape.wheels_m) {
    const cv::Point hub(texels(wheel), texels(height - shape.wheel_radius_m));
    const int radius = texels(shape.wheel_radius_m);
    cv::circle(image, hub, radius + 6, {26, 26, 26, 255}, -1);
    cv::circle(image, hub, radius - 1, {38, 37, 36, 255}, -1);
    cv::circle(image, hub, radius * 6 / 10, {150, 150, 150, 255}, -1);
    const int spokes = random.uniform(5, 9);
    for (int i = 0; i < spokes; ++i) {
      const double angle = 2 * CV_PI * i / spokes;
      cv::line(image, hub,
               hub + cv::Point(static_cast<int>(radius * 0.55 * std::cos(angle)),
                               static_cast<int>(radius * 0.55 * std::sin(angle))),
               {70, 70, 70, 255}, 3);
    }
  }
  return image;
}

std::string any_plate(cv::RNG& random) {
  std::string plate;
  for (int i = 0; i < 2; ++i) plate += static_cast<char>('A' + random.uniform(0, 26));
  plate += ' ';
  for (int i = 0; i < 4; ++i) plate += static_cast<char>('0' + random.uniform(0, 10));
  return plate;
}

// The front or back, up to `height_m` above its sill.
cv::Mat paint_end(double width_m, double height_m, const cv::Scalar& body, bool is_front,
                  cv::RNG& random) {
  cv::Mat image(texels(height_m), texels(width_m), CV_8UC3, body);
  // Measured from the left and up from the sill.
  const auto box = [&](double left, double up, double width, double height,
                       const cv::Scalar& colour) {
    cv::rectangle(image, {texels(left), texels(height_m - up - height)},
                  {texels(left + width) - 1, texels(height_m - up) - 1}, colour, -1);
  };
  const double middle = width_m / 2;
  box(0, 0, width_m, 0.13, body * 0.45);
  if (is_front) {
    box(middle - 0.4, 0.24, 0.8, 0.15, {35, 34, 33});
    for (int i = 0; i < 4; ++i) box(middle - 0.38, 0.25 + 0.035 * i, 0.76, 0.012, {120, 120, 120});
  } else if (height_m > 1.2) {  // a van's doors and their windows
    box(middle - 0.01, 0.13, 0.02, height_m - 0.2, body * 0.5);
    for (const double left : {middle - 0.75, middle + 0.15}) {
      box(left, height_m * 0.55, 0.6, height_m * 0.32, {60, 53, 48});
      box(left + 0.04, height_m * 0.7, 0.35, height_m * 0.14, {92, 82, 74});
    }
  }
  const cv::Scalar lamp = is_front ? cv::Scalar(225, 232, 238) : cv::Scalar(36, 28, 165);
  const double lamp_height = is_front ? 0.17 : 0.26;
  for (const double left : {0.05, width_m - 0.05 - 0.3}) {
    box(left, 0.28, 0.3, lamp_height, lamp);
    box(left + 0.03, 0.31, 0.24, 0.05, is_front ? lamp * 0.75 : cv::Scalar(60, 130, 220));
  }
  box(middle - 0.26, 0.13, 0.52, 0.115, {228, 232, 232});
  cv::putText(image, any_plate(random), {texels(middle - 0.235), texels(height_m - 0.155)},
              cv::FONT_HERSHEY_DUPLEX, 0.29, {30, 30, 30}, 1, cv::LINE_AA);
  weather(image, 2, 3, random);
  return image;
}

// A truck's back doors.
cv::Mat paint_doors(double width_m, double height_m, const cv::Scalar& body, cv::RNG& random) {
  cv::Mat image(texels(height_m), texels(width_m), CV_8UC3, body);
  const int middle = image.cols / 2;
  cv::line(image, {middle, 0}, {middle, image.rows}, body * 0.4, 3);
  for (const int x : {middle - 40, middle - 26, middle + 26, middle + 40}) {
    cv::line(image, {x, 10}, {x, image.rows - 60}, {150, 152, 154}, 4);
    for (int y = 30; y < image.rows - 60; y += 70) {
      cv::rectangle(image, {x - 5, y}, {x + 5, y + 10}, {90, 92, 94}, -1);
    }
  }
  const std::string word = kFirms[random.uniform(0, 8)];
  int baseline = 0;
  const cv::Size one = cv::getTextSize(word, cv::FONT_HERSHEY_DUPLEX, 1, 2, &baseline);
  const double scale = image.cols * 0.8 / one.width;
  cv::putText(image, word, {image.cols / 10, image.rows / 3}, cv::FONT_HERSHEY_DUPLEX, scale,
              varied({90, 60, 60}, 50, random), std::max(2, static_cast<int>(scale * 2)),
              cv::LINE_AA);
  for (int stripe = 0; stripe < 12; ++stripe) {  // the warning board
    const int x = stripe * image.cols / 12;
    const cv::Scalar colour = stripe % 2 == 0 ? cv::Scalar(40, 40, 190) : cv::Scalar(215, 220, 222);
    cv::rectangle(image, {x, image.rows - 45}, {x + image.cols / 12, image.rows - 20}, colour, -1);
  }
  for (const int x : {8, image.cols - 60}) {
    cv::rectangle(image, {x, image.rows - 18}, {x + 52, image.rows - 4}, {36, 28, 175}, -1);
  }
  weather(image, 3, 8, random);
  return image;
}

cv::Mat paint_plain(double width_m, double length_m, const cv::Scalar& colour, cv::RNG& random) {
  cv::Mat image(texels(length_m) / 2, texels(width_m) / 2, CV_8UC3, colour);
  weather(image, 2, 5, random);
  return image;
}

}  // namespace

Vehicle::Vehicle(VehicleKind kind, std::uint64_t seed) : kind_(kind) {
  cv::RNG random = seeded(seed);
  cv::Scalar body = any_body_colour(random);
  if (kind == VehicleKind::van || kind == VehicleKind::truck) {
    body = random.uniform(0, 3) > 0 ? varied({222, 224, 224}, 12, random) : body;
  }
  const Shape& shape = shape_of(kind);
  const double width = shape.width_m;
  const double end_m = kind == VehicleKind::truck ? 2.6 : kind == VehicleKind::van ? 1.9 : 0.75;
  side_ = painted([=](cv::RNG& own) { return paint_side(kind, body, own); }, seed + 1);
  front_ = painted([=](cv::RNG& own) { return paint_end(width, 0.5, body, true, own); }, seed + 2);
  back_ = painted(
      [=](cv::RNG& own) {
        return kind == VehicleKind::truck ? paint_doors(width, end_m, body, own)
                                          : paint_end(width, end_m, body, false, own);
      },
      seed + 3);
  top_ = painted([=](cv::RNG& own) { return paint_plain(width, 6, body, own); }, seed + 4);
  glass_ = painted(
      [=](cv::RNG& own) {
        return paint_plain(width, 1, {66, 58, 52}, own);
      },
      seed + 5);
  underneath_ = std::make_shared<Texture>(cv::Mat(4, 4, CV_8UC3, cv::Scalar(22, 22, 22)));
}

double Vehicle::length_m() const { return shape_of(kind_).length_m(); }
double Vehicle::width_m() const { return shape_of(kind_).width_m; }
double Vehicle::height_m() const { return shape_of(kind_).height_m(); }

void Vehicle::add_to(std::vector<Surface>& surfaces, const Point& centre,
                     const cv::Vec2d& forward) const {
  const Shape& shape = shape_of(kind_);
  const Point ahead(forward[0], forward[1], 0);
  const Point right(forward[1], -forward[0], 0);
  const double half_m = shape.length_m() / 2;
  const auto place = [&](const Side& side, double across_m) {
    return centre + ahead * (half_m - side.back_m) + right * across_m + kUp * side.up_m;
  };
  const double half_width = shape.width_m / 2;
  const auto add = [&](std::vector<Point> corners, const std::shared_ptr<const Texture>& texture,
                       const TextureMap& map) {
    surfaces.push_back(polygon(corners, texture, map));
  };
  // Across, strip by strip from the front over the roof to the back.
  for (std::size_t i = 0; i + 1 < shape.outline.size(); ++i) {
    const Side& from = shape.outline[i];
    const Side& to = shape.outline[i + 1];
    const Point a = place(from, -half_width);
    const Point b = place(from, half_width);
    const Point c = place(to, half_width);
    const Point d = place(to, -half_width);
    const bool is_front = i == 0;
    const bool is_back = i + 2 == shape.outline.size();
    const Point run = cv::normalize(d - a);
    if (is_front) {  // read from ahead: left is the vehicle's right
      add({c, d, a, b}, front_,
          {c, -right * kTexelsPerM, -run * (0.5 * kTexelsPerM / cv::norm(d - a))});
    } else if (is_back) {
      add({a, b, c, d}, back_, {a, right * kTexelsPerM, run * kTexelsPerM});
    } else {
      add({d, c, b, a}, shape.is_glass[i] ? glass_ : top_,
          {d, right * (kTexelsPerM / 2.0), -run * (kTexelsPerM / 2.0)});
    }
    Point out = run.cross(right);
    const Point away = (a + b + c + d) * 0.25 - centre - kUp * 0.8;
    surfaces.back().normal = out.dot(away) < 0 ? -out : out;
  }
  // The sides, cut out of one texture whose left is the front, as seen from the vehicle's left.
  const Point top = kUp * shape.height_m();
  for (const double side : {-1.0, 1.0}) {
    const Point front = centre + ahead * half_m + right * (side * half_width);
    const Point back = front - ahead * (2 * half_m);
    add({front + top, back + top, back, front}, side_,
        {front + top, -ahead * kTexelsPerM, -kUp * kTexelsPerM});
    surfaces.back().normal = right * side;
    surfaces.back().is_cut_out = true;
  }
  // The dark underbody.
  const Point low = kUp * 0.26;
  const auto floor = [&](double along, double across) {
    return centre + ahead * (along * (half_m - 0.1)) + right * (across * (half_width - 0.05));
  };
  add({floor(1, -1) + low, floor(1, 1) + low, floor(-1, 1) + low, floor(-1, -1) + low}, underneath_,
      {centre, ahead, right});
  surfaces.back().openness = 0.2F;
  add({floor(1, -1) + kUp * 0.03, floor(1, 1) + kUp * 0.03, floor(-1, 1) + kUp * 0.03,
       floor(-1, -1) + kUp * 0.03},
      underneath_, {centre, ahead, right});
}

Shade Vehicle::shade(const Point& centre, const cv::Vec2d& forward) const {
  return {centre, forward, length_m() / 2, width_m() / 2, height_m() * 0.95};
}

}  // namespace milepost::simulator
