#include <cmath>
#include <system_error>

#include "schema/base/csv.h"
#include "schema/drive/checks.h"
#include "schema/drive/description.h"
#include "schema/drive/drive.h"
#include "schema/drive/tables.h"

namespace milepost {
namespace fs = std::filesystem;
namespace {

// Beyond this a local tangent plane deviates too far from the Earth's surface.
constexpr double kMaxLocalM = 1e6;

// The numbers of a row from `first_column` on. Errors: as CsvTable::number.
Result<std::vector<double>> numbers(const CsvTable& table, std::size_t row,
                                    std::size_t first_column, std::size_t end_column) {
  std::vector<double> values;
  for (std::size_t column = first_column; column < end_column; ++column) {
    const Result<double> value = table.number(row, column);
    if (!value) return value.error();
    values.push_back(*value);
  }
  return values;
}

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

RowPlaces places_of(const CsvTable& table, const fs::path& file) {
  RowPlaces rows{file.string(), {}};
  for (std::size_t row = 0; row < table.row_count(); ++row) rows.lines.push_back(table.line(row));
  return rows;
}

Result<GeoPoint> position_from_local(const LocalFrame& frame, const EnuPoint& enu,
                                     const std::string& place) {
  for (const double metres : {enu.east_m, enu.north_m, enu.up_m}) {
    if (std::abs(metres) > kMaxLocalM) {
      return Error{ErrorCode::invalid_input, place,
                   "the position lies 1000 km or more from the origin",
                   "give metres east, north and up of the origin in drive.json"};
    }
  }
  return frame.geo_from_enu(enu);
}

// REQUIRES: `of` is the frame's as it was recorded.
void set_attitude(const GeoAttitude& of, Frame& frame) {
  frame.position = of.position;
  frame.heading_deg = wrapped_360(of.heading_deg);
  frame.pitch_deg = of.pitch_deg;
  frame.roll_deg = of.roll_deg;
}

// The frames of trajectory.csv, of the reference point, before they are checked.
Result<std::vector<Frame>> frames_of(const CsvTable& table, const Drive& drive) {
  std::optional<LocalFrame> local;
  if (drive.origin) local.emplace(*drive.origin);
  const std::optional<std::size_t> sigma_column = table.column(kPositionSigmaColumn);
  const std::optional<std::size_t> pitch_column = table.column(kPitchColumn);
  const std::optional<std::size_t> roll_column = table.column(kRollColumn);
  std::vector<Frame> frames;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const Result<std::vector<double>> values = numbers(table, row, 1, kLocalColumns.size());
    if (!values) return values.error();
    const std::vector<double>& v = *values;
    Frame frame;
    frame.filename = table.text(row, 0);
    frame.timestamp_s = v[0];
    frame.line = table.line(row);
    GeoAttitude recorded{{v[1], v[2], v[3]}, v[4]};
    if (sigma_column) {
      const Result<double> sigma_m = table.number(row, *sigma_column);
      if (!sigma_m) return sigma_m.error();
      frame.position_sigma_m = *sigma_m;
    }
    for (const auto& [column, angle] :
         {std::pair{pitch_column, &recorded.pitch_deg}, {roll_column, &recorded.roll_deg}}) {
      if (!column) continue;
      const Result<double> degrees = table.number(row, *column);
      if (!degrees) return degrees.error();
      *angle = *degrees;
    }
    if (local) {
      const auto position = position_from_local(*local, {v[1], v[2], v[3]}, table.place(row));
      if (!position) return position.error();
      recorded.position = *position;
    }
    set_attitude(recorded, frame);
    frames.push_back(std::move(frame));
  }
  return frames;
}

Status check_images_exist(const Drive& drive, const RowPlaces& rows) {
  for (std::size_t row = 0; row < drive.frames.size(); ++row) {
    const fs::path image = drive.frame_path(drive.frames[row]);
    std::error_code ignored;
    if (!fs::is_regular_file(image, ignored)) {
      return Error{ErrorCode::not_found, rows.place(row), "there is no image " + image.string(),
                   "add the image or remove the row"};
    }
  }
  return ok_status();
}

Status read_trajectory(Drive& drive) {
  const fs::path file = drive.folder / kTrajectoryFile;
  const bool is_local = drive.position_frame == PositionFrame::local;
  const auto table = CsvTable::read(file, is_local ? kLocalColumns : kGeographicColumns,
                                    {kPositionSigmaColumn, kPitchColumn, kRollColumn});
  if (!table) return table.error();
  Result<std::vector<Frame>> frames = frames_of(*table, drive);
  if (!frames) return frames.error();
  drive.frames = std::move(frames).value();
  const RowPlaces rows = places_of(*table, file);
  if (Status status = check_frames(drive.frames, rows); !status) return status;
  drive.has_tilts = table->column(kPitchColumn) || table->column(kRollColumn);
  for (Frame& frame : drive.frames) {
    set_attitude(
        camera_of_vehicle({frame.position, frame.heading_deg, frame.pitch_deg, frame.roll_deg},
                          drive.camera.mounting),
        frame);
  }
  return check_images_exist(drive, rows);
}

Status read_gps(Drive& drive) {
  const fs::path file = drive.folder / kGpsFile;
  if (!is_there(file)) return ok_status();
  const Result<CsvTable> table = CsvTable::read(file, kGpsColumns);
  if (!table) return table.error();
  for (std::size_t row = 0; row < table->row_count(); ++row) {
    const Result<std::vector<double>> values = numbers(*table, row, 0, kGpsColumns.size());
    if (!values) return values.error();
    const std::vector<double>& v = *values;
    drive.gps.push_back({v[0], {v[1], v[2], 0}, v[3]});
  }
  return check_gps(drive.gps, places_of(*table, file));
}

Status read_odometry(Drive& drive) {
  const fs::path file = drive.folder / kOdometryFile;
  if (!is_there(file)) return ok_status();
  const Result<CsvTable> table = CsvTable::read(file, kOdometryColumns);
  if (!table) return table.error();
  for (std::size_t row = 0; row < table->row_count(); ++row) {
    const Result<std::vector<double>> values = numbers(*table, row, 0, kOdometryColumns.size());
    if (!values) return values.error();
    const std::vector<double>& v = *values;
    drive.odometry.push_back({v[0], v[1], v[2]});
  }
  return check_odometry(drive.odometry, places_of(*table, file));
}

}  // namespace

std::vector<fs::path> files_of(const Drive& drive) {
  std::vector<fs::path> files;
  for (const char* name : {kDescriptionFile, kTrajectoryFile, kGpsFile, kOdometryFile}) {
    files.push_back(drive.folder / name);
  }
  for (const Frame& frame : drive.frames) files.push_back(drive.frame_path(frame));
  return files;
}

Result<Drive> read_drive(const fs::path& folder) {
  Result<Drive> drive = read_description(folder);
  if (!drive) return drive;
  for (const auto read_table : {read_trajectory, read_gps, read_odometry}) {
    if (Status status = read_table(*drive); !status) return status.error();
  }
  return drive;
}

}  // namespace milepost
