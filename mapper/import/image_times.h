// The images of a recording and when they were taken.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mapper/import/recording.h"
#include "schema/base/result.h"

namespace milepost {

// Seconds since 1970 of "2011-09-30 12:40:59.123", with 'T' or a blank, with or without 'Z'.
std::optional<double> seconds_of_date(std::string_view text);
std::optional<double> seconds_of_date(int year, unsigned month, unsigned day, int hour, int minute,
                                      double second);

// Images of a folder, by name. Errors: not_found, invalid_input (none).
Result<std::vector<std::filesystem::path>> images_in(const std::filesystem::path& folder);

// The images of a folder with the times of a file: a table with the columns filename,timestamp_s;
// lines of a time and a name, as TUM writes them; or a time a line, in the order of the images'
// names. Without a file they are taken at a rate from 0 on, in the order of the names, or, if that
// is 0, names that are numbers are times: seconds, milli-, micro- or nanoseconds. Errors:
// not_found, io, invalid_input.
Result<std::vector<RecordedImage>> timed_images(const std::filesystem::path& folder,
                                                const std::filesystem::path& times,
                                                double rate_hz = 0);

// The images of --images, a folder or a video, with their times: of --times, of the video, of the
// images' names, or by --rate-hz. Errors: those of timed_images and open_video.
Status add_images(const ImportOptions& options, Recording& recording);

// Times that are whole seconds, several images in each, evenly within their second.
void spread_whole_seconds(std::vector<RecordedImage>& images);

}  // namespace milepost
