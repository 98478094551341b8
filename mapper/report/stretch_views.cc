#include "mapper/report/stretch_views.h"

#include <algorithm>
#include <array>

#include "schema/base/digits.h"

namespace milepost {
namespace {

using Value = std::optional<double> StretchValues::*;

// Classes between limits, from the best to the worst.
struct Scale {
  Value value;
  std::vector<double> limits;
  bool is_less_better;
  const char* unit;

  // A limit belongs to the better class.
  int class_of(double value_) const {
    int index = 0;
    for (const double limit : limits) {
      if (is_less_better ? value_ <= limit : value_ >= limit) return index;
      ++index;
    }
    return index;
  }
};

const std::array<Scale, 5>& scales() {
  static const std::array<Scale, 5> all = {{
      {&StretchValues::sigma_world_m, {0.05, 0.1, 0.2, 0.5}, true, " m"},
      {&StretchValues::sigma_map_m, {0.03, 0.05, 0.1, 0.2}, true, " m"},
      {&StretchValues::landmarks_per_m, {12, 8, 4, 2}, false, " a metre"},
      {&StretchValues::passes, {8, 4, 3, 2}, false, ""},
      {&StretchValues::fit_percent, {95, 85, 70, 50}, false, " %"},
  }};
  return all;
}

// "up to 0.05 m", "up to 0.1 m", ..., "more than 0.5 m"; "12 or more", ..., "less than 2".
std::vector<ViewClass> classes_of(const Scale& scale, const std::array<const char*, 5>& colours) {
  std::vector<ViewClass> classes;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const bool is_last = i == scale.limits.size();
    const std::string limit =
        shortest(is_last ? scale.limits.back() : scale.limits[i]) + scale.unit;
    const std::string words = scale.is_less_better
                                  ? (is_last ? "more than " + limit : "up to " + limit)
                                  : (is_last ? "less than " + limit : limit + " or more");
    classes.push_back({words, colours.at(i)});
  }
  return classes;
}

// Blue is good, red is bad; the colours differ in lightness, too.
constexpr std::array<const char*, 5> kGoodToBad = {"v0", "v1", "v2", "v3", "v4"};
// From many to few.
constexpr std::array<const char*, 5> kManyToFew = {"q4", "q3", "q2", "q1", "q0"};

constexpr const char* kWorld =
    "The standard deviation of a fix in the world, on the worse of the two axes along and across "
    "the road: that of one image against the landmarks mapped from there, each found as often as "
    "its observations and drives promise and with the noise that the client takes, at the weakest "
    "place of the ten metres, together with the error of the map's own positions; other lanes, "
    "light and traffic are not in it.";
constexpr const char* kMap =
    "The standard deviation of a fix against the map, approximated as that in the world, but "
    "without the error of the map's own positions: what the landmarks in sight allow.";
constexpr const char* kLandmarks =
    "Landmarks of the default method whose first observation lies in the ten metres, by their "
    "length.";
constexpr const char* kPasses =
    "How often drives passed the segment. With one pass the map cannot tell its own error: it is "
    "stated by the drive, or assumed.";
constexpr const char* kFit =
    "The share of the features followed in the images of all drives that fit the adjusted poses. "
    "Where it is low the images contradict the recorded positions, headings or the camera.";

}  // namespace

const std::vector<StretchView>& stretch_views() {
  static const std::vector<StretchView> all = {
      {"\u03C3 of a fix in the world", "world_class", classes_of(scales()[0], kGoodToBad),
       "not known", kWorld},
      {"\u03C3 against the map", "map_class", classes_of(scales()[1], kGoodToBad),
       "no landmark in sight", kMap},
      {"landmarks a metre", "landmarks_class", classes_of(scales()[2], kGoodToBad), "no landmarks",
       kLandmarks},
      {"passes",
       "passes_class",
       {{"8 or more", kManyToFew[0]},
        {"4 to 7", kManyToFew[1]},
        {"3", kManyToFew[2]},
        {"2", kManyToFew[3]},
        {"1", kManyToFew[4]}},
       "not told",
       kPasses},
      {"fit of the images", "fit_class", classes_of(scales()[4], kGoodToBad), "not recorded", kFit},
  };
  return all;
}

StretchValues values_of(const MapStretch& stretch, std::size_t passes) {
  StretchValues values;
  values.sigma_world_m = stretch.sigma_world_m;
  if (stretch.sigma_map) values.sigma_map_m = stretch.sigma_map->worse_m();
  values.landmarks_per_m = static_cast<double>(stretch.landmarks) / stretch.length_m();
  if (passes > 0) values.passes = static_cast<double>(passes);
  std::uint64_t followed = 0;
  std::uint64_t fitting = 0;
  for (const StretchFit& each : stretch.fits) {
    followed += each.fit.followed;
    fitting += each.fit.fitting;
  }
  if (followed > 0)
    values.fit_percent = 100 * static_cast<double>(fitting) / static_cast<double>(followed);
  return values;
}

std::vector<std::optional<int>> classes_of(const StretchValues& values) {
  std::vector<std::optional<int>> classes;
  for (const Scale& scale : scales()) {
    const std::optional<double>& value = values.*scale.value;
    classes.push_back(value ? std::optional(scale.class_of(*value)) : std::nullopt);
  }
  return classes;
}

}  // namespace milepost
