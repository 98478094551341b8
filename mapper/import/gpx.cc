#include <ogrsf_frmts.h>

#include <cmath>

#include "mapper/geodata/gdal.h"
#include "mapper/import/image_times.h"
#include "mapper/import/layouts.h"

namespace milepost {
namespace {

// Seconds since 1970 of a time that was read with its zone.
std::optional<double> time_of(OGRFeature& point) {
  const int field = point.GetFieldIndex("time");
  int year = 0;
  int month = 0;
  int day = 0;
  int hour = 0;
  int minute = 0;
  float second = 0;
  int zone = 0;
  if (field < 0 ||
      point.GetFieldAsDateTime(field, &year, &month, &day, &hour, &minute, &second, &zone) == 0)
    return std::nullopt;
  // A float has milliseconds of a minute, and a little beside them.
  const double in_milliseconds = std::round(1000 * static_cast<double>(second)) / 1000;
  const auto seconds = seconds_of_date(year, static_cast<unsigned>(month),
                                       static_cast<unsigned>(day), hour, minute, in_milliseconds);
  constexpr int kUtc = 100;
  constexpr double kQuarterHourS = 900;
  if (!seconds || zone <= 1) return seconds;
  return *seconds - (zone - kUtc) * kQuarterHourS;
}

}  // namespace

// Heights are as the receiver wrote them, most often above the sea.
Result<Recording> read_gpx(const ImportOptions& options) {
  GDALAllRegister();
  const QuietGdal quiet;
  const char* const drivers[] = {"GPX", nullptr};
  const Dataset file(
      GDALDataset::Open(options.trajectory.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, drivers),
      GDALClose);
  OGRLayer* const points = file ? file->GetLayerByName("track_points") : nullptr;
  if (points == nullptr) {
    return Error{ErrorCode::invalid_input, options.trajectory.string(),
                 "cannot be read as GPX" + QuietGdal::in_brackets(), "name a file with a track"};
  }
  Recording recording;
  recording.has_headings = false;
  recording.is_receivers = true;
  points->ResetReading();
  while (const OGRFeatureUniquePtr point{points->GetNextFeature()}) {
    const OGRPoint* const place =
        point->GetGeometryRef() == nullptr ? nullptr : point->GetGeometryRef()->toPoint();
    const auto time = time_of(*point);
    if (place == nullptr || !time) continue;
    const int elevation = point->GetFieldIndex("ele");
    const double altitude_m = elevation < 0 ? 0 : point->GetFieldAsDouble(elevation);
    recording.poses.push_back({*time, {{place->getY(), place->getX(), altitude_m}}});
  }
  if (recording.poses.empty()) {
    return Error{ErrorCode::invalid_input, options.trajectory.string(),
                 "holds no track point with a time", "name a file with a recorded track"};
  }
  if (const Status added = add_images(options, recording); !added) return added.error();
  return recording;
}

}  // namespace milepost
