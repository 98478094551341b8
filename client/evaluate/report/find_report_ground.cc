// What the plans of a found drive lie on: the picture from above and the walls.
#include <sodium.h>

#include "client/evaluate/report/find_plan_areas.h"
#include "client/evaluate/report/find_report_figures.h"
#include "client/evaluate/report/plot/text.h"

namespace milepost {
namespace {

using plot::coordinate;
using plot::Point;

std::string base64_of(ByteView bytes) {
  std::string text(sodium_base64_ENCODED_LEN(bytes.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(),
                    sodium_base64_VARIANT_ORIGINAL);
  text.pop_back();  // the terminating zero
  return text;
}

// The picture's two sides are straight and even in metres, as far as a plan reaches.
std::string image_of(const PagePicture& picture, const LocalFrame& frame) {
  const Point origin = on_plan(frame, picture.top_left);
  const Point right = on_plan(frame, picture.top_right);
  const Point down = on_plan(frame, picture.bottom_left);
  const auto metre = [](double value) { return coordinate(value, 3); };
  return R"(<image class="backdrop" width="1" height="1" preserveAspectRatio="none" )"
         "transform=\"matrix(" +
         metre(right.x - origin.x) + " " + metre(origin.y - right.y) + " " +
         metre(down.x - origin.x) + " " + metre(origin.y - down.y) + " " + metre(origin.x) + " " +
         metre(-origin.y) + ")\" href=\"data:image/jpeg;base64," + base64_of(picture.jpeg) +
         "\"/>\n";
}

std::string picture_beneath(const FoundSeries& series, const LocalFrame& frame) {
  if (!series.input->backdrop) return "";
  const std::optional<PagePicture> picture =
      page_picture(*series.input->backdrop, shown_bounds(series));
  return picture ? image_of(*picture, frame) : "";
}

std::string walls_of(const std::vector<PlanWall>& walls) {
  std::string data;
  const auto place = [](const Eigen::Vector2d& enu_m) {
    return coordinate(enu_m.x(), 2) + " " + coordinate(-enu_m.y(), 2);
  };
  for (const PlanWall& wall : walls) data += "M" + place(wall.begin_m) + "L" + place(wall.end_m);
  return R"(<path class="wall" d=")" + data + "\"/>\n";
}

}  // namespace

std::string plan_ground(const FoundSeries& series) {
  const LocalFrame frame(series.input->recorder->origin());
  return std::string(R"(<svg class="defs" aria-hidden="true"><defs><g id=")") + kPlanGround +
         "\">\n" + picture_beneath(series, frame) + walls_of(series.input->recorder->walls()) +
         "</g></defs></svg>\n";
}

}  // namespace milepost
