#include <numeric>
#include <system_error>

#include "schema/base/csv_text.h"
#include "schema/base/file.h"
#include "schema/drive/checks.h"
#include "schema/drive/description.h"
#include "schema/drive/drive.h"
#include "schema/drive/tables.h"

namespace milepost {
namespace fs = std::filesystem;
namespace {

constexpr int kMetreDecimals = 6;
constexpr int kGeoDecimals = 11;  // of a degree: about a micrometre
constexpr int kAngleDecimals = 6;
constexpr int kRateDecimals = 6;

std::string header_of(const std::vector<std::string>& columns) {
  std::string header = columns.front();
  for (std::size_t i = 1; i < columns.size(); ++i) header += ',' + columns[i];
  return header;
}

std::string trajectory_text(const Drive& drive) {
  const bool is_local = drive.position_frame == PositionFrame::local;
  std::optional<LocalFrame> local;
  if (is_local) local.emplace(*drive.origin);
  std::vector<std::string> columns = is_local ? kLocalColumns : kGeographicColumns;
  const bool states_sigma = !drive.frames.empty() && drive.frames.front().position_sigma_m;
  if (states_sigma) columns.push_back(kPositionSigmaColumn);
  if (drive.has_tilts) columns.insert(columns.end(), {kPitchColumn, kRollColumn});
  CsvText csv(header_of(columns));
  for (const Frame& frame : drive.frames) {
    csv.cell(frame.filename);
    csv.exact(frame.timestamp_s);
    const GeoAttitude recorded =
        vehicle_of_camera({frame.position, frame.heading_deg, frame.pitch_deg, frame.roll_deg},
                          drive.camera.mounting);
    if (local) {
      const EnuPoint enu = local->enu_from_geo(recorded.position);
      csv.rounded(enu.east_m, kMetreDecimals);
      csv.rounded(enu.north_m, kMetreDecimals);
      csv.rounded(enu.up_m, kMetreDecimals);
    } else {
      csv.rounded(recorded.position.latitude_deg, kGeoDecimals);
      csv.rounded(recorded.position.longitude_deg, kGeoDecimals);
      csv.rounded(recorded.position.altitude_m, kMetreDecimals);
    }
    csv.rounded(recorded.heading_deg, kAngleDecimals);
    if (states_sigma) csv.exact(frame.position_sigma_m.value_or(0));
    if (drive.has_tilts) {
      csv.rounded(recorded.pitch_deg, kAngleDecimals).rounded(recorded.roll_deg, kAngleDecimals);
    }
    csv.end_row();
  }
  return csv.text();
}

std::string gps_text(const Drive& drive) {
  CsvText csv(header_of(kGpsColumns));
  for (const GpsFix& fix : drive.gps) {
    csv.exact(fix.timestamp_s);
    csv.rounded(fix.position.latitude_deg, kGeoDecimals);
    csv.rounded(fix.position.longitude_deg, kGeoDecimals);
    csv.exact(fix.sigma_m);
    csv.end_row();
  }
  return csv.text();
}

std::string odometry_text(const Drive& drive) {
  CsvText csv(header_of(kOdometryColumns));
  for (const Odometry& reading : drive.odometry) {
    csv.exact(reading.timestamp_s);
    csv.rounded(reading.speed_mps, kRateDecimals);
    csv.rounded(reading.yaw_rate_dps, kRateDecimals);
    csv.end_row();
  }
  return csv.text();
}

// The line numbers of `count` rows below the header.
RowPlaces rows_to_write(const fs::path& file, std::size_t count) {
  RowPlaces rows{file.string(), std::vector<std::size_t>(count)};
  std::iota(rows.lines.begin(), rows.lines.end(), std::size_t{2});
  return rows;
}

// Nothing is written that read_drive would reject.
Status check_drive(const Drive& drive, const fs::path& folder) {
  const std::string description = (folder / kDescriptionFile).string();
  if (drive.position_frame == PositionFrame::local && !(drive.origin && is_valid(*drive.origin))) {
    return Error{ErrorCode::invalid_input, description, "a local drive has no valid origin",
                 "set the drive's origin"};
  }
  Status status = check_camera(drive.camera, description);
  if (status) status = check_images_folder(drive.images, description);
  if (status) status = check_position_error(drive.position_error, description);
  if (status) {
    const RowPlaces rows = rows_to_write(folder / kTrajectoryFile, drive.frames.size());
    status = check_frames(drive.frames, rows);
  }
  if (status) status = check_gps(drive.gps, rows_to_write(folder / kGpsFile, drive.gps.size()));
  if (status) {
    const RowPlaces rows = rows_to_write(folder / kOdometryFile, drive.odometry.size());
    status = check_odometry(drive.odometry, rows);
  }
  return status;
}

// Writes an optional table, or removes that of an earlier drive from the folder.
Status write_optional(const fs::path& file, bool is_present, const std::string& text) {
  if (is_present) return write_text_file(file, text);
  std::error_code error;
  fs::remove(file, error);
  if (!error) return ok_status();
  return Error{ErrorCode::io, file.string(), "cannot be removed (" + error.message() + ")",
               "remove the old table"};
}

}  // namespace

Status write_drive(const Drive& drive, const fs::path& folder) {
  if (Status status = check_drive(drive, folder); !status) return status;
  const Result<std::string> description = description_text(drive);
  if (!description) return description.error();
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    return Error{ErrorCode::io, folder.string(), "cannot be created (" + error.message() + ")",
                 "check the path and the permissions"};
  }
  Status status = write_text_file(folder / kDescriptionFile, *description);
  if (status) status = write_text_file(folder / kTrajectoryFile, trajectory_text(drive));
  if (status) status = write_optional(folder / kGpsFile, !drive.gps.empty(), gps_text(drive));
  if (status) {
    status = write_optional(folder / kOdometryFile, !drive.odometry.empty(), odometry_text(drive));
  }
  return status;
}

}  // namespace milepost
