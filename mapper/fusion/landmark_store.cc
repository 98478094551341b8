#include "mapper/fusion/landmark_store.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace milepost {
namespace {

// One row's content; it is read by the process that wrote it.
struct Row {
  Descriptor descriptor;
  GeoPoint position;
  double covariance_m2[9];
  double depth_m, depth_sigma_m, size_m, size_sigma;
  AlongRange along;
  double right_m;
  std::uint64_t observations;
  std::uint64_t pass;
  double stretch_m;
};
static_assert(std::is_trivially_copyable_v<Row>);

Row row_of(const PassLandmark& from) {
  const MappedLandmark& landmark = from.landmark;
  Row row{};
  row.descriptor = landmark.descriptor;
  row.position = landmark.position;
  Eigen::Map<Eigen::Matrix3d>(row.covariance_m2) = landmark.covariance_m2;
  row.depth_m = landmark.depth_m;
  row.depth_sigma_m = landmark.depth_sigma_m;
  row.size_m = landmark.size_m;
  row.size_sigma = landmark.size_sigma;
  row.along = landmark.along;
  row.right_m = landmark.right_m;
  row.observations = landmark.observations;
  row.pass = from.pass;
  row.stretch_m = from.stretch_m;
  return row;
}

PassLandmark landmark_of(const Row& row) {
  PassLandmark to;
  to.landmark.descriptor = row.descriptor;
  to.landmark.position = row.position;
  to.landmark.covariance_m2 = Eigen::Map<const Eigen::Matrix3d>(row.covariance_m2);
  to.landmark.depth_m = row.depth_m;
  to.landmark.depth_sigma_m = row.depth_sigma_m;
  to.landmark.size_m = row.size_m;
  to.landmark.size_sigma = row.size_sigma;
  to.landmark.along = row.along;
  to.landmark.right_m = row.right_m;
  to.landmark.observations = row.observations;
  to.pass = row.pass;
  to.stretch_m = row.stretch_m;
  return to;
}

}  // namespace

Result<LandmarkStore> LandmarkStore::create() {
  auto database = sqlite::Database::open_temporary();
  if (!database) return database.error();
  const Status made = database->execute(
      "CREATE TABLE landmarks (segment INTEGER, tile INTEGER, content BLOB);"
      "CREATE INDEX by_tile ON landmarks (segment, tile);"
      "BEGIN");
  if (!made.ok()) return made.error();
  auto insert = database->prepare("INSERT INTO landmarks VALUES (?, ?, ?)");
  if (!insert) return insert.error();
  auto select = database->prepare(
      "SELECT content FROM landmarks WHERE segment = ? AND tile = ? ORDER BY rowid");
  if (!select) return select.error();
  return LandmarkStore(std::move(*database), std::move(*insert), std::move(*select));
}

Status LandmarkStore::add(std::size_t segment, std::uint32_t tile, const PassLandmark& landmark) {
  const Row row = row_of(landmark);
  insert_.bind(1, static_cast<std::int64_t>(segment))
      .bind(2, static_cast<std::int64_t>(tile))
      .bind(3, ByteView(reinterpret_cast<const std::uint8_t*>(&row), sizeof(row)));
  return insert_.run();
}

Result<std::vector<PassLandmark>> LandmarkStore::read(std::size_t segment, std::uint32_t tile) {
  select_.reset();
  select_.bind(1, static_cast<std::int64_t>(segment)).bind(2, static_cast<std::int64_t>(tile));
  std::vector<PassLandmark> landmarks;
  for (;;) {
    const Result<bool> more = select_.step();
    if (!more) return more.error();
    if (!*more) break;
    Row row{};
    std::memcpy(&row, select_.blob(0).data(), sizeof(row));
    landmarks.push_back(landmark_of(row));
  }
  select_.reset();
  std::ranges::stable_sort(landmarks, {},
                           [](const PassLandmark& each) { return each.landmark.along.from_m; });
  return landmarks;
}

}  // namespace milepost
