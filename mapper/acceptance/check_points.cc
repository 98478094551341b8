#include "mapper/acceptance/check_points.h"

#include <algorithm>
#include <optional>

#include "mapper/geodata/coordinate_transform.h"
#include "mapper/geodata/datum_transform.h"
#include "schema/base/csv.h"

namespace milepost {
namespace {

// Coordinates of the table as positions of the map's datum.
class MarkPositions {
 public:
  static Result<MarkPositions> of(const std::string& crs, const Datum& datum) {
    MarkPositions positions;
    if (crs.empty()) return positions;
    auto transform = CoordinateTransform::from(crs);
    if (!transform) {
      Error error = transform.error();
      error.where = "--check-crs";
      return error;
    }
    positions.crs_ = std::move(*transform);
    const Datum stated{positions.crs_->datum(), {}};
    if (!datum.is_stated() || datum.name == stated.name) return positions;
    auto to_map = DatumTransform::between(stated, datum);
    if (!to_map) {
      return Error{ErrorCode::invalid_input, "--check-crs",
                   "its marks are of " + stated.name + ", the map of " + datum.text() + ": " +
                       to_map.error().what,
                   "give the marks in a reference system of the map's datum"};
    }
    positions.datum_ = std::move(*to_map);
    return positions;
  }

  std::vector<std::string> columns() const {
    if (crs_) return {"x", "y", "z"};
    return {"longitude_deg", "latitude_deg", "altitude_m"};
  }

  Result<GeoPoint> at(double x, double y, double z) const {
    GeoPoint position{y, x, z};
    if (crs_) {
      const auto geographic = crs_->geographic_of(x, y, z);
      if (!geographic) return geographic.error();
      position = *geographic;
    }
    if (datum_) return datum_->transformed(position);
    if (is_valid(position)) return position;
    return Error{ErrorCode::invalid_input, "", "the mark has no position on the Earth",
                 "write degrees and metres"};
  }

 private:
  std::optional<CoordinateTransform> crs_;
  std::optional<DatumTransform> datum_;
};

// The table, with the places of its columns.
class MarkTable {
 public:
  static Result<MarkTable> read(const std::filesystem::path& file,
                                const std::vector<std::string>& coordinates) {
    std::vector<std::string> wanted = {"mark", "filename", "x_px", "y_px"};
    wanted.insert(wanted.end(), coordinates.begin(), coordinates.end());
    std::vector<std::string> all = wanted;
    all.emplace_back("drive");
    auto table = CsvTable::read(file, {}, all);
    if (!table) return table.error();
    for (const std::string& name : wanted) {
      if (table->column(name)) continue;
      return Error{
          ErrorCode::invalid_input, file.string(), "has no column '" + name + "'",
          "write a row for each sight of a mark: mark, its position, filename, x_px, y_px"};
    }
    return MarkTable(std::move(*table));
  }

  std::size_t row_count() const { return table_.row_count(); }
  bool has_drives() const { return table_.column("drive").has_value(); }
  std::string place(std::size_t row) const { return table_.place(row); }
  const std::string& text(std::size_t row, const std::string& name) const {
    return table_.text(row, *table_.column(name));
  }
  Result<double> number(std::size_t row, const std::string& name) const {
    return table_.number(row, *table_.column(name));
  }

 private:
  explicit MarkTable(CsvTable table) : table_(std::move(table)) {}
  CsvTable table_;
};

// The drive that a row is about. Errors: invalid_input.
Result<const Drive*> drive_of(const MarkTable& table, std::size_t row,
                              const std::vector<Drive>& drives) {
  if (!table.has_drives()) {
    if (drives.size() == 1) return &drives.front();
    return Error{ErrorCode::invalid_input, table.place(row), "does not name its drive",
                 "add the column drive: there are " + std::to_string(drives.size())};
  }
  const std::string& name = table.text(row, "drive");
  const auto found = std::ranges::find(drives, name, &Drive::name);
  if (found != drives.end()) return &*found;
  return Error{ErrorCode::invalid_input, table.place(row), "there is no drive '" + name + "'",
               "name a drive as its drive.json does"};
}

Result<CheckPointSight> sight_of(const MarkTable& table, std::size_t row,
                                 const std::vector<Drive>& drives) {
  const auto drive = drive_of(table, row, drives);
  if (!drive) return drive.error();
  const auto x_px = table.number(row, "x_px");
  if (!x_px) return x_px.error();
  const auto y_px = table.number(row, "y_px");
  if (!y_px) return y_px.error();
  const std::string& filename = table.text(row, "filename");
  if (std::ranges::find((*drive)->frames, filename, &Frame::filename) == (*drive)->frames.end()) {
    return Error{ErrorCode::invalid_input, table.place(row),
                 "drive " + (*drive)->name + " has no frame '" + filename + "'",
                 "name an image of its trajectory"};
  }
  const Camera& camera = (*drive)->camera;
  const bool is_inside =
      *x_px >= -0.5 && *y_px >= -0.5 && *x_px < camera.width_px && *y_px < camera.height_px;
  if (is_inside) return CheckPointSight{(*drive)->name, filename, {*x_px, *y_px}};
  return Error{ErrorCode::invalid_input, table.place(row), "the mark is seen beside the image",
               "write pixels from the centre of the top left one"};
}

Result<GeoPoint> position_of(const MarkTable& table, std::size_t row,
                             const MarkPositions& positions) {
  std::vector<double> coordinates;
  for (const std::string& column : positions.columns()) {
    const auto value = table.number(row, column);
    if (!value) return value.error();
    coordinates.push_back(*value);
  }
  const auto position = positions.at(coordinates[0], coordinates[1], coordinates[2]);
  if (position) return position;
  Error error = position.error();
  error.where = table.place(row);
  return error;
}

}  // namespace

Result<std::vector<CheckPoint>> read_check_points(const std::filesystem::path& file,
                                                  const std::string& crs, const Datum& datum,
                                                  const std::vector<Drive>& drives) {
  constexpr double kSameM = 1e-3;
  const auto positions = MarkPositions::of(crs, datum);
  if (!positions) return positions.error();
  const auto table = MarkTable::read(file, positions->columns());
  if (!table) return table.error();
  std::vector<CheckPoint> points;
  for (std::size_t row = 0; row < table->row_count(); ++row) {
    const auto position = position_of(*table, row, *positions);
    if (!position) return position.error();
    auto sight = sight_of(*table, row, drives);
    if (!sight) return sight.error();
    const std::string& mark = table->text(row, "mark");
    auto known = std::ranges::find(points, mark, &CheckPoint::mark);
    if (known == points.end()) {
      points.push_back({mark, *position, {}});
      known = points.end() - 1;
    }
    const double apart_m = std::hypot(geodesic_distance_m(known->position, *position),
                                      known->position.altitude_m - position->altitude_m);
    if (apart_m > kSameM) {
      return Error{ErrorCode::invalid_input, table->place(row),
                   "mark '" + mark + "' has another position than before",
                   "give each mark one position"};
    }
    known->sights.push_back(std::move(*sight));
  }
  if (!points.empty()) return points;
  return Error{ErrorCode::invalid_input, file.string(), "holds no mark",
               "write a row for each sight of a mark"};
}

}  // namespace milepost
