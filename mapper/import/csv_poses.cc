#include <map>

#include "mapper/geodata/coordinate_transform.h"
#include "mapper/import/image_times.h"
#include "mapper/import/layouts.h"
#include "mapper/import/what_names.h"
#include "schema/base/csv.h"

namespace milepost {
namespace {

// What a column may hold.
const std::vector<std::string> kWhats = {"time", "latitude", "longitude", "height", "x",    "y",
                                         "z",    "heading",  "pitch",     "roll",   "image"};

class PoseTable {
 public:
  static Result<PoseTable> read(const ImportOptions& options) {
    auto names = names_by_what("--columns", options.columns, kWhats);
    if (!names) return names.error();
    for (const std::string& what : kWhats) names->try_emplace(what, what);
    std::vector<std::string> wanted;
    for (const auto& [what, name] : *names) wanted.push_back(name);
    auto table = CsvTable::read(options.trajectory, {}, wanted);
    if (!table) return table.error();
    return PoseTable(std::move(*table), std::move(*names));
  }

  bool has(const std::string& what) const { return table_.column(names_.at(what)).has_value(); }
  std::size_t row_count() const { return table_.row_count(); }
  std::string place(std::size_t row) const { return table_.place(row); }
  const std::string& text(std::size_t row, const std::string& what) const {
    return table_.text(row, *table_.column(names_.at(what)));
  }
  // REQUIRES: the column is there.
  Result<double> number(std::size_t row, const std::string& what) const {
    return table_.number(row, *table_.column(names_.at(what)));
  }
  // Seconds, or a date with its time of day.
  Result<double> time(std::size_t row) const {
    if (const auto seconds = seconds_of_date(text(row, "time"))) return *seconds;
    return number(row, "time");
  }

 private:
  PoseTable(CsvTable table, std::map<std::string, std::string> names)
      : table_(std::move(table)), names_(std::move(names)) {}

  CsvTable table_;
  std::map<std::string, std::string> names_;
};

// The columns of the coordinates: degrees and metres, or of --crs.
Result<std::vector<std::string>> coordinate_columns(const PoseTable& table,
                                                    const ImportOptions& options) {
  const std::vector<std::string> wanted = options.crs.empty()
                                              ? std::vector<std::string>{"longitude", "latitude"}
                                              : std::vector<std::string>{"x", "y"};
  for (const std::string& what : {wanted[0], wanted[1], std::string("time")}) {
    if (table.has(what)) continue;
    return Error{ErrorCode::invalid_input, options.trajectory.string(),
                 "has no column '" + what + "'",
                 "name it with --columns " + what +
                     "=NAME; with --crs x, y and z hold the "
                     "coordinates"};
  }
  std::vector<std::string> columns = wanted;
  const std::string up = options.crs.empty() ? "height" : "z";
  if (table.has(up)) columns.push_back(up);
  return columns;
}

}  // namespace

Result<Recording> read_csv(const ImportOptions& options) {
  const auto table = PoseTable::read(options);
  if (!table) return table.error();
  const auto columns = coordinate_columns(*table, options);
  if (!columns) return columns.error();
  std::optional<CoordinateTransform> transform;
  if (!options.crs.empty()) {
    auto made = CoordinateTransform::from(options.crs);
    if (!made) return made.error();
    transform = std::move(*made);
  }
  Recording recording;
  if (transform) recording.datum.name = transform->datum();
  recording.has_headings = table->has("heading");
  recording.has_tilts = table->has("pitch") || table->has("roll");
  for (std::size_t row = 0; row < table->row_count(); ++row) {
    RecordedPose pose;
    const Result<double> time = table->time(row);
    if (!time) return time.error();
    pose.timestamp_s = *time;
    std::vector<double> xyz(3, 0);
    for (std::size_t i = 0; i < columns->size(); ++i) {
      const Result<double> value = table->number(row, (*columns)[i]);
      if (!value) return value.error();
      xyz[i] = *value;
    }
    pose.attitude.position = {xyz[1], xyz[0], xyz[2]};
    if (transform) {
      Result<GeoPoint> position = transform->geographic_of(xyz[0], xyz[1], xyz[2]);
      if (!position) {
        Error error = position.error();
        error.where = table->place(row);
        return error;
      }
      pose.attitude.position = *position;
    }
    for (const auto& [what, angle] : {std::pair{"heading", &pose.attitude.heading_deg},
                                      {"pitch", &pose.attitude.pitch_deg},
                                      {"roll", &pose.attitude.roll_deg}}) {
      if (!table->has(what)) continue;
      const Result<double> value = table->number(row, what);
      if (!value) return value.error();
      *angle = *value;
    }
    if (table->has("image"))
      recording.images.push_back({options.images / table->text(row, "image"), pose.timestamp_s});
    recording.poses.push_back(pose);
  }
  if (table->has("image")) return recording;
  if (const Status added = add_images(options, recording); !added) return added.error();
  return recording;
}

}  // namespace milepost
