#include "schema/store/map_content.h"

#include <optional>

#include "schema/base/digest.h"

namespace milepost {
namespace {

// One table that the build covers, its rows in the order of their keys.
struct List {
  const char* count;
  const char* rows;
  const char* columns;  // one letter each: t text, i integer, r real
};

constexpr List kLists[] = {
    {"SELECT count(*) FROM layers", "SELECT name, parameters FROM layers ORDER BY name", "tt"},
    {"SELECT count(*) FROM segments", "SELECT id, length_m FROM segments ORDER BY id", "tr"},
    {"SELECT count(*) FROM vertices",
     "SELECT segment, position, latitude_deg, longitude_deg, altitude_m, along_m FROM vertices "
     "ORDER BY segment, position",
     "tirrrr"},
    {"SELECT count(*) FROM successors",
     "SELECT segment, position, successor FROM successors ORDER BY segment, position", "tit"},
    {"SELECT count(*) FROM tiles",
     "SELECT segment, layer, number, from_m, to_m, items, bytes, digest FROM tiles "
     "ORDER BY segment, layer, number",
     "ttirriit"},
    {"SELECT count(*) FROM cells",
     "SELECT layer, number, items, bytes, digest FROM cells ORDER BY layer, number", "tiiit"},
};

void add_row(FieldDigest& digest, const sqlite::Statement& row, const char* columns) {
  for (int i = 0; columns[i] != '\0'; ++i) {
    if (columns[i] == 't') {
      digest.add(row.text(i));
    } else if (columns[i] == 'i') {
      digest.add(static_cast<std::uint64_t>(row.integer(i)));
    } else {
      digest.add(row.real(i));
    }
  }
}

// Runs a query and passes each of its rows to `use`.
template <class Use>
Status for_each_content_row(const sqlite::Database& map, const char* query, Use use) {
  Result<sqlite::Statement> statement = map.prepare(query);
  if (!statement) return statement.error();
  while (true) {
    const Result<bool> row = statement->step();
    if (!row) return row.error();
    if (!*row) return ok_status();
    use(*statement);
  }
}

Status add_list(FieldDigest& digest, const sqlite::Database& map, const List& list) {
  const Status counted = for_each_content_row(map, list.count, [&](const sqlite::Statement& row) {
    digest.add(static_cast<std::uint64_t>(row.integer(0)));
  });
  if (!counted.ok()) return counted;
  return for_each_content_row(
      map, list.rows, [&](const sqlite::Statement& row) { add_row(digest, row, list.columns); });
}

}  // namespace

Result<std::string> build_of(const sqlite::Database& map) {
  FieldDigest digest;
  digest.add(static_cast<std::uint64_t>(kMapFormatVersion));
  Status status =
      for_each_content_row(map, "SELECT value FROM meta WHERE key = 'feature'",
                           [&](const sqlite::Statement& row) { digest.add(row.text(0)); });
  for (const List& list : kLists) {
    if (!status.ok()) return status.error();
    status = add_list(digest, map, list);
  }
  if (!status.ok()) return status.error();
  return digest.finish();
}

Result<Bounds> bounds_of(const sqlite::Database& map) {
  std::optional<Bounds> bounds;
  const auto add = [&bounds](const Bounds& box) { bounds = bounds ? bounds->joined(box) : box; };
  Status status =
      for_each_content_row(map,
                           "SELECT min(longitude_deg), min(latitude_deg), max(longitude_deg), "
                           "max(latitude_deg) FROM vertices HAVING count(*) > 0",
                           [&](const sqlite::Statement& row) {
                             add({row.real(0), row.real(1), row.real(2), row.real(3)});
                           });
  if (!status.ok()) return status.error();
  status = for_each_content_row(map, "SELECT number FROM cells", [&](const sqlite::Statement& row) {
    add(GridCell::numbered(static_cast<std::uint32_t>(row.integer(0))).bounds());
  });
  if (!status.ok()) return status.error();
  return bounds.value_or(Bounds{});
}

}  // namespace milepost
