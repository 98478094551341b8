#include "mapper/import/image_times.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <map>
#include <optional>
#include <sstream>
#include <system_error>

#include "mapper/import/video.h"
#include "schema/base/csv.h"
#include "schema/base/file.h"
#include "schema/base/median.h"
#include "schema/base/number.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;

// Seconds of a number that counts a smaller unit since 1970, or seconds.
double seconds_since_1970(double value) {
  for (const double unit : {1e9, 1e6, 1e3})
    if (value / unit > 1e8) return value / unit;
  return value;
}

std::optional<double> time_of(const std::string& text) {
  if (const auto value = finite_number(text)) return value;
  return seconds_of_date(text);
}

bool is_image(const fs::path& file) {
  constexpr std::array<std::string_view, 9> kEndings = {".jpg", ".jpeg", ".png", ".tif", ".tiff",
                                                        ".bmp", ".pgm",  ".ppm", ".webp"};
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::find(kEndings, ending) != kEndings.end();
}

Error wrong(const fs::path& file, std::size_t line, const std::string& what,
            const std::string& hint) {
  const std::string place = line == 0 ? "" : ", line " + std::to_string(line);
  return {ErrorCode::invalid_input, file.string() + place, what, hint};
}

// A time as it was written, with the image's name if the line has one.
struct TimeLine {
  double timestamp_s = 0;
  std::string name;
  std::size_t line = 0;
};

// "TIME", "TIME NAME" or "NAME TIME" a line; a date with its time of day may have a blank.
Result<std::vector<TimeLine>> time_lines(const fs::path& file) {
  const Result<std::string> text = read_text_file(file);
  if (!text) return text.error();
  std::vector<TimeLine> lines;
  std::istringstream stream(*text);
  std::string line;
  for (std::size_t at = 1; std::getline(stream, line); ++at) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.find_first_not_of(" \t") == std::string::npos || line.front() == '#') continue;
    if (const auto time = time_of(line)) {
      lines.push_back({*time, "", at});
      continue;
    }
    std::istringstream words(line);
    std::string first;
    std::string second;
    words >> first >> second;
    const auto before = time_of(first);
    const auto after = time_of(second);
    if (!before && !after) {
      return wrong(file, at, "'" + line.substr(0, 40) + "' holds no time",
                   "write a time a line, or the columns filename,timestamp_s");
    }
    lines.push_back(before ? TimeLine{*before, second, at} : TimeLine{*after, first, at});
  }
  return lines;
}

Result<std::vector<RecordedImage>> from_table(const fs::path& folder, const fs::path& times) {
  const auto table = CsvTable::read(times, {"filename", "timestamp_s"});
  if (!table) return table.error();
  std::vector<RecordedImage> images;
  for (std::size_t row = 0; row < table->row_count(); ++row) {
    const auto time = time_of(table->text(row, 1));
    if (!time) {
      return Error{ErrorCode::invalid_input, table->place(row),
                   "timestamp_s is '" + table->text(row, 1) + "', no time",
                   "write seconds, or a date and time as 2011-09-30T12:40:59.123"};
    }
    images.push_back({folder / table->text(row, 0), *time});
  }
  return images;
}

bool begins_with_columns(const fs::path& file) {
  const Result<std::string> text = read_text_file(file);
  return text && text->substr(0, 60).find("timestamp_s") != std::string::npos;
}

Result<std::vector<RecordedImage>> from_names(const std::vector<fs::path>& files) {
  std::vector<RecordedImage> images;
  for (const fs::path& file : files) {
    const auto time = finite_number(file.stem().string());
    if (!time) {
      return wrong(file, 0, "its name is no time", "name the images' times with --times FILE");
    }
    images.push_back({file, seconds_since_1970(*time)});
  }
  return images;
}

}  // namespace

std::optional<double> seconds_of_date(std::string_view text) {
  int year = 0;
  unsigned month = 0;
  unsigned day = 0;
  int hour = 0;
  int minute = 0;
  double second = 0;
  const auto take = [&text](auto& value, std::string_view ends) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc()) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (ends.empty()) return true;
    if (text.empty() || ends.find(text.front()) == std::string_view::npos) return false;
    text.remove_prefix(1);
    return true;
  };
  if (!take(year, "-:") || !take(month, "-:") || !take(day, "T ") || !take(hour, ":") ||
      !take(minute, ":") || !take(second, ""))
    return std::nullopt;
  if (text == "Z") text.remove_prefix(1);
  if (!text.empty()) return std::nullopt;
  return seconds_of_date(year, month, day, hour, minute, second);
}

std::optional<double> seconds_of_date(int year, unsigned month, unsigned day, int hour, int minute,
                                      double second) {
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(month),
                                         std::chrono::day(day)};
  if (!date.ok() || hour > 23 || minute > 59 || !(second < 61)) return std::nullopt;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return 86400.0 * static_cast<double>(days) + 3600.0 * hour + 60.0 * minute + second;
}

Result<std::vector<fs::path>> images_in(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (is_image(at->path())) files.push_back(at->path());
  if (error) {
    return Error{ErrorCode::not_found, folder.string(), "cannot be read (" + error.message() + ")",
                 "name the folder of the images"};
  }
  if (files.empty()) {
    return Error{ErrorCode::invalid_input, folder.string(), "holds no images",
                 "name the folder of the images"};
  }
  std::ranges::sort(files);
  return files;
}

Status add_images(const ImportOptions& options, Recording& recording) {
  std::error_code error;
  if (!fs::is_regular_file(options.images, error)) {
    auto images = timed_images(options.images, options.times, options.rate_hz);
    if (!images) return images.error();
    recording.images = std::move(*images);
    return ok_status();
  }
  if (!options.times.empty()) {
    return wrong(options.images, 0, "is a video, which has times of its own",
                 "leave out --times, and correct its clock with --time-offset-s");
  }
  auto video = open_video(options.images, options.rate_hz);
  if (!video) return video.error();
  recording.images = std::move(video->images);
  recording.container = std::move(video->frames);
  return ok_status();
}

Result<std::vector<RecordedImage>> timed_images(const fs::path& folder, const fs::path& times,
                                                double rate_hz) {
  const auto files = images_in(folder);
  if (!files) return files.error();
  if (times.empty() && rate_hz > 0) {
    std::vector<RecordedImage> images;
    images.reserve(files->size());
    for (const fs::path& file : *files)
      images.push_back({file, static_cast<double>(images.size()) / rate_hz});
    return images;
  }
  if (times.empty()) return from_names(*files);
  if (begins_with_columns(times)) return from_table(folder, times);
  const auto lines = time_lines(times);
  if (!lines) return lines.error();
  const bool have_names = !lines->empty() && !lines->front().name.empty();
  if (!have_names && lines->size() != files->size()) {
    return wrong(times, 0,
                 "has " + std::to_string(lines->size()) + " times for " +
                     std::to_string(files->size()) + " images in " + folder.string(),
                 "give a time for each image, or name the images in the file");
  }
  std::vector<RecordedImage> images;
  for (std::size_t i = 0; i < lines->size(); ++i) {
    const TimeLine& line = (*lines)[i];
    if (have_names == line.name.empty())
      return wrong(times, line.line, "has no name of an image", "name all images or none");
    images.push_back(
        {have_names ? folder / fs::path(line.name).filename() : (*files)[i], line.timestamp_s});
  }
  return images;
}

void spread_whole_seconds(std::vector<RecordedImage>& images) {
  std::map<double, std::vector<RecordedImage*>> of_second;
  for (RecordedImage& image : images) of_second[image.timestamp_s].push_back(&image);
  if (of_second.size() < 2) return;
  std::vector<double> counts;
  counts.reserve(of_second.size());
  for (const auto& [second, these] : of_second) counts.push_back(static_cast<double>(these.size()));
  const double usual = median_of(counts);
  const double last = of_second.rbegin()->first;
  for (const auto& [second, these] : of_second) {
    const auto count = static_cast<double>(these.size());
    // The first second may have begun before the recording, the last one may end after it.
    const bool is_first = second == of_second.begin()->first;
    const double rate = is_first || second == last ? std::max(usual, count) : count;
    const double begin = is_first ? rate - count : 0;
    for (std::size_t i = 0; i < these.size(); ++i)
      these[i]->timestamp_s = second + (begin + static_cast<double>(i)) / rate;
  }
}

}  // namespace milepost
