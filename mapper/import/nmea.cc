#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>

#include "mapper/import/image_times.h"
#include "mapper/import/layouts.h"
#include "schema/base/file.h"
#include "schema/base/number.h"

namespace milepost {
namespace {

constexpr double kDayS = 86400;

// The fields of a sentence; nothing if it is none, or its checksum is wrong.
std::optional<std::vector<std::string>> fields_of(std::string line) {
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
  const std::size_t begin = line.find('$');
  if (begin == std::string::npos) return std::nullopt;
  line.erase(0, begin + 1);
  if (const std::size_t star = line.find('*'); star != std::string::npos) {
    unsigned sum = 0;
    for (const char c : line.substr(0, star)) sum ^= static_cast<unsigned char>(c);
    unsigned stated = 0;
    const char* const first = line.data() + star + 1;
    const auto [end, error] = std::from_chars(first, line.data() + line.size(), stated, 16);
    if (error != std::errc() || end == first || stated != sum) return std::nullopt;
    line.resize(star);
  }
  std::vector<std::string> fields;
  std::istringstream stream(line + ',');
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  return fields;
}

std::optional<double> number_in(const std::vector<std::string>& fields, std::size_t index) {
  return index < fields.size() ? finite_number(fields[index]) : std::nullopt;
}

// hhmmss.sss as seconds of the day.
std::optional<double> time_of_day(const std::vector<std::string>& fields, std::size_t index) {
  const auto value = number_in(fields, index);
  if (!value || *value < 0 || *value >= 240000) return std::nullopt;
  const double hours = std::floor(*value / 10000);
  const double minutes = std::floor((*value - 10000 * hours) / 100);
  return 3600 * hours + 60 * minutes + (*value - 10000 * hours - 100 * minutes);
}

// dddmm.mmm and its hemisphere.
std::optional<double> degrees_of(const std::vector<std::string>& fields, std::size_t index) {
  const auto value = number_in(fields, index);
  if (!value || index + 1 >= fields.size()) return std::nullopt;
  const double whole = std::floor(*value / 100);
  const double degrees = whole + (*value - 100 * whole) / 60;
  const std::string& hemisphere = fields[index + 1];
  return hemisphere == "S" || hemisphere == "W" ? -degrees : degrees;
}

// The begin of the day of ddmmyy.
std::optional<double> day_of(const std::vector<std::string>& fields, std::size_t index) {
  const auto value = number_in(fields, index);
  if (!value || fields[index].size() != 6) return std::nullopt;
  const auto ddmmyy = static_cast<unsigned>(*value);
  return seconds_of_date(2000 + static_cast<int>(ddmmyy % 100), ddmmyy / 100 % 100, ddmmyy / 10000,
                         0, 0, 0);
}

}  // namespace

// GGA sentences give time, position, and the height above the ellipsoid: altitude and geoid
// separation together. RMC and ZDA sentences give the day. Sentences without a fix are left out.
Result<Recording> read_nmea(const ImportOptions& options) {
  const Result<std::string> text = read_text_file(options.trajectory);
  if (!text) return text.error();
  Recording recording;
  recording.has_headings = false;
  recording.is_receivers = true;
  std::optional<double> day_s;
  std::optional<double> latest_of_day_s;
  std::size_t without_day = 0;
  std::istringstream stream(*text);
  for (std::string line; std::getline(stream, line);) {
    const auto fields = fields_of(std::move(line));
    if (!fields || fields->front().size() < 5) continue;
    const std::string kind = fields->front().substr(2);
    if (kind == "RMC") {
      if (const auto day = day_of(*fields, 9)) {
        day_s = *day;
        for (std::size_t i = recording.poses.size() - without_day; i < recording.poses.size(); ++i)
          recording.poses[i].timestamp_s += *day;
        without_day = 0;
      }
      continue;
    }
    if (kind != "GGA") continue;
    const auto of_day_s = time_of_day(*fields, 1);
    const auto latitude_deg = degrees_of(*fields, 2);
    const auto longitude_deg = degrees_of(*fields, 4);
    const auto quality = number_in(*fields, 6);
    const auto altitude_m = number_in(*fields, 9);
    if (!of_day_s || !latitude_deg || !longitude_deg || !altitude_m || quality.value_or(0) == 0)
      continue;
    // Midnight passes before the next date comes.
    if (day_s && latest_of_day_s && *of_day_s < *latest_of_day_s - kDayS / 2) *day_s += kDayS;
    latest_of_day_s = of_day_s;
    if (!day_s) ++without_day;
    recording.poses.push_back(
        {day_s.value_or(0) + *of_day_s,
         {{*latitude_deg, *longitude_deg, *altitude_m + number_in(*fields, 11).value_or(0)}}});
  }
  if (recording.poses.empty()) {
    return Error{ErrorCode::invalid_input, options.trajectory.string(),
                 "holds no GGA sentence with a position", "record GGA sentences"};
  }
  if (const Status added = add_images(options, recording); !added) return added.error();
  return recording;
}

}  // namespace milepost
