#include <system_error>
#include <utility>

#include "schema/base/digest.h"
#include "schema/base/file.h"
#include "schema/base/json.h"
#include "schema/document/manifest.h"
#include "schema/document/stored_map.h"
#include "schema/geo/datum.h"
#include "schema/store/map_checks.h"
#include "schema/store/map_content.h"
#include "schema/store/map_output.h"
#include "schema/store/map_rows.h"
#include "schema/store/map_sql.h"
#include "schema/store/map_store.h"
#include "schema/store/sqlite.h"

namespace milepost {
namespace fs = std::filesystem;
namespace {

// For the same bytes from the same calls, and constant memory: a fixed page size, zeros in unused
// space, one transaction. No journal: an unfinished file is discarded as a whole, and publish_file
// syncs a finished one.
constexpr const char* kWriteSettings =
    "PRAGMA page_size = 4096; PRAGMA encoding = 'UTF-8'; PRAGMA auto_vacuum = NONE;"
    "PRAGMA secure_delete = ON; PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF;"
    "PRAGMA locking_mode = EXCLUSIVE; PRAGMA cache_size = -8192; PRAGMA foreign_keys = ON;";

enum Insert {
  kInsertMeta,
  kInsertLayer,
  kInsertSegment,
  kInsertVertex,
  kInsertSuccessor,
  kInsertPass,
  kInsertFrame,
  kInsertTile,
  kInsertCell,
  kUpdatePositionError
};
constexpr const char* kSetPositionError =
    "UPDATE segments SET position_sigma_m = ?, position_correlation_m = ?, assumed = ? "
    "WHERE id = ?";
constexpr const char* kInserts[] = {
    "INSERT INTO meta VALUES (?, ?)",
    "INSERT INTO layers VALUES (?, ?)",
    "INSERT INTO segments VALUES (?, ?, ?, ?, ?)",
    "INSERT INTO vertices VALUES (?, ?, ?, ?, ?, ?)",
    "INSERT INTO successors VALUES (?, ?, ?, ?)",
    "INSERT INTO passes VALUES (?, ?, ?, ?, ?)",
    "INSERT INTO frames VALUES (?, ?)",
    "INSERT INTO tiles VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)",
    "INSERT INTO cells VALUES (?, ?, ?, ?, ?, ?)",
    kSetPositionError,
};
Error wrong_call(const fs::path& file, const std::string& what) {
  return {ErrorCode::invalid_input, file.string(), what, ""};
}

// Readers parse the parameters of layers and features.
bool is_json_object(const std::string& text) {
  const Result<nlohmann::json> json = read_json(text);
  return json && json->is_object();
}

// The database of an unfinished map. The statements are destroyed before their connection.
struct Session {
  sqlite::Database database;
  std::vector<sqlite::Statement> inserts;
};

Result<Session> start_session(const fs::path& partial) {
  Result<sqlite::Database> database = sqlite::Database::open(partial, sqlite::Access::read_write);
  if (!database) return database.error();
  Status status = database->execute(kWriteSettings);
  if (status.ok()) status = database->execute("BEGIN EXCLUSIVE");
  if (status.ok()) status = database->execute(kMapSql);
  if (!status.ok()) return status.error();
  Session session{std::move(*database), {}};
  for (const char* sql : kInserts) {
    Result<sqlite::Statement> insert = session.database.prepare(sql);
    if (!insert) return insert.error();
    session.inserts.push_back(std::move(*insert));
  }
  return session;
}

}  // namespace

struct MapWriter::Impl {
  fs::path file;
  fs::path partial;                // empty once it is published
  std::optional<Session> session;  // until finish()
  MapSummary stated;               // what the table meta will have
  std::int64_t frames = 0;
  Status failure;  // the first one, which is final: without a journal there is no rollback

  ~Impl() {
    session.reset();
    remove_partial();
  }

  void remove_partial() const {
    std::error_code ignored;
    if (!partial.empty()) fs::remove(partial, ignored);
  }

  sqlite::Statement& insert(Insert kind) { return session->inserts[kind]; }

  // The user knows the map's name, not that of the partial file.
  Error named(Error error) const {
    error.where = file.string();
    return error;
  }

  // Records a failure.
  Status keep(const Status& status) {
    if (!status.ok()) failure = named(status.error());
    return failure;
  }

  template <class Value>
  Status add_meta(const char* key, const Value& value) {
    return insert(kInsertMeta).bind(1, std::string_view(key)).bind(2, value).run();
  }

  Status add_vertices(const StoredSegment& segment) {
    std::int64_t position = 0;
    for (const StoredVertex& v : segment.vertices) {
      const Status added = insert(kInsertVertex)
                               .bind(1, segment.id)
                               .bind(2, position++)
                               .bind(3, v.latitude_deg)
                               .bind(4, v.longitude_deg)
                               .bind(5, v.altitude_m)
                               .bind(6, v.along_m)
                               .run();
      if (!added.ok()) return added;
    }
    return ok_status();
  }

  Status add_row(const StoredSegment& segment) {
    const PositionError& error = segment.position_error;
    return insert(kInsertSegment)
        .bind(1, segment.id)
        .bind(2, segment.length_m)
        .bind(3, error.sigma_m)
        .bind(4, error.correlation_m)
        .bind(5, std::int64_t{error.is_assumed})
        .run();
  }

  Status add_successors(const StoredSegment& segment) {
    std::int64_t position = 0;
    for (const Successor& successor : segment.successors) {
      const Status added = insert(kInsertSuccessor)
                               .bind(1, segment.id)
                               .bind(2, position++)
                               .bind(3, successor.map)
                               .bind(4, successor.segment)
                               .run();
      if (!added.ok()) return added;
    }
    return ok_status();
  }

  Status add_passes(const StoredSegment& segment) {
    std::int64_t position = 0;
    for (const StoredPass& pass : segment.passes) {
      const Status added = insert(kInsertPass)
                               .bind(1, segment.id)
                               .bind(2, position++)
                               .bind(3, pass.drive)
                               .bind(4, pass.from_m)
                               .bind(5, pass.to_m)
                               .run();
      if (!added.ok()) return added;
    }
    return ok_status();
  }

  // Returns the id of the stored bytes.
  Result<std::int64_t> add_frame(ByteView frame) {
    const std::int64_t id = frames++;
    const Status stored = insert(kInsertFrame).bind(1, id).bind(2, frame).run();
    if (!stored.ok()) return stored.error();
    return id;
  }

  Status add_bounds(const Bounds& bounds) {
    Status status = add_meta("west_deg", bounds.west_deg);
    if (status.ok()) status = add_meta("south_deg", bounds.south_deg);
    if (status.ok()) status = add_meta("east_deg", bounds.east_deg);
    if (status.ok()) status = add_meta("north_deg", bounds.north_deg);
    return status;
  }

  // Adds what is known only at the end. Returns the build.
  Result<std::string> complete() {
    const Result<Bounds> bounds = bounds_of(session->database);
    if (!bounds) return bounds.error();
    stated.bounds = *bounds;
    const Result<Manifest> manifest = manifest_of(session->database, stated);
    if (!manifest) return manifest.error();
    const std::string document = manifest_document(*manifest);
    std::string build = digest_of(as_bytes(document));
    Status status = add_bounds(*bounds);
    if (status.ok()) status = add_meta("feature", stated.feature_json);
    if (status.ok() && !stated.datum.empty()) status = add_meta("datum", stated.datum);
    if (status.ok() && !stated.mapping.empty()) status = add_meta("mapping", stated.mapping);
    if (status.ok()) status = add_meta("manifest", document);
    if (status.ok()) status = add_meta("build", build);
    if (status.ok()) status = session->database.execute("COMMIT");
    if (!status.ok()) return status.error();
    return build;
  }
};

MapWriter::MapWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MapWriter::MapWriter(MapWriter&&) noexcept = default;
MapWriter& MapWriter::operator=(MapWriter&&) noexcept = default;
MapWriter::~MapWriter() = default;

Result<MapWriter> MapWriter::create(const fs::path& file) {
  if (const Status free = check_outputs({{"--map", file, &kMapOutput}}, {}); !free) {
    return free.error();
  }
  auto impl = std::make_unique<Impl>();
  impl->file = file;
  impl->partial = partial_path_for(file);
  impl->remove_partial();  // left by a killed process with the same process id
  Result<Session> session = start_session(impl->partial);
  if (!session) return impl->named(session.error());
  impl->session = std::move(*session);
  return MapWriter(std::move(impl));
}

Status MapWriter::set_feature_json(const std::string& json) {
  if (!impl_->failure.ok()) return impl_->failure;
  if (!is_json_object(json)) {
    return wrong_call(impl_->file, "the feature parameters are not a JSON object (FORMAT.md 2.3)");
  }
  impl_->stated.feature_json = json;
  return ok_status();
}

Status MapWriter::set_datum(const std::string& datum) {
  if (!impl_->failure.ok()) return impl_->failure;
  if (!datum.empty() && !Datum::from(datum))
    return wrong_call(impl_->file, "'" + datum + "' is no datum");
  impl_->stated.datum = datum;
  return ok_status();
}

Status MapWriter::set_mapping_document(const std::string& text) {
  if (!impl_->failure.ok()) return impl_->failure;
  if (!text.empty() && !is_json_object(text))
    return wrong_call(impl_->file, "the record of its mapping is not a JSON object");
  impl_->stated.mapping = text;
  return ok_status();
}

Status MapWriter::add_layer(const std::string& name, const std::string& parameters_json) {
  if (!impl_->failure.ok()) return impl_->failure;
  if (!is_layer_name(name)) return wrong_call(impl_->file, "'" + name + "' is not a layer name");
  if (!is_json_object(parameters_json)) {
    return wrong_call(impl_->file,
                      "the parameters of layer " + name + " are not a JSON object (FORMAT.md 2.4)");
  }
  return impl_->keep(impl_->insert(kInsertLayer).bind(1, name).bind(2, parameters_json).run());
}

Status MapWriter::add_segment(const StoredSegment& segment) {
  if (!impl_->failure.ok()) return impl_->failure;
  if (Status checked = check_segment(segment, impl_->file.string()); !checked) return checked;
  Status status = impl_->add_row(segment);
  if (status.ok()) status = impl_->add_vertices(segment);
  if (status.ok()) status = impl_->add_successors(segment);
  if (status.ok()) status = impl_->add_passes(segment);
  return impl_->keep(status);
}

Status MapWriter::set_position_error(const std::string& segment, const PositionError& error) {
  if (!impl_->failure.ok()) return impl_->failure;
  const std::string where = impl_->file.string() + ", segment " + segment;
  if (Status checked = check_position_error(error, where); !checked) return checked;
  return impl_->keep(impl_->insert(kUpdatePositionError)
                         .bind(1, error.sigma_m)
                         .bind(2, error.correlation_m)
                         .bind(3, std::int64_t{error.is_assumed})
                         .bind(4, segment)
                         .run());
}

Status MapWriter::add_tile(const std::string& segment, const std::string& layer,
                           std::uint32_t index, const AlongRange& along, std::uint64_t items,
                           ByteView frame) {
  if (!impl_->failure.ok()) return impl_->failure;
  const std::string where = impl_->file.string() + ", " + tile_name(segment, layer, index);
  if (Status checked = check_along(along, where); !checked) return checked;
  if (Status checked = check_frame(frame.size(), items, where); !checked) return checked;
  const Result<std::int64_t> frame_id = impl_->add_frame(frame);
  if (!frame_id) return impl_->keep(frame_id.error());
  return impl_->keep(impl_->insert(kInsertTile)
                         .bind(1, segment)
                         .bind(2, layer)
                         .bind(3, static_cast<std::int64_t>(index))
                         .bind(4, along.from_m)
                         .bind(5, along.to_m)
                         .bind(6, static_cast<std::int64_t>(items))
                         .bind(7, static_cast<std::int64_t>(frame.size()))
                         .bind(8, digest_of(frame))
                         .bind(9, *frame_id)
                         .run());
}

Status MapWriter::add_cell(const std::string& layer, std::uint32_t cell, std::uint64_t items,
                           ByteView frame) {
  if (!impl_->failure.ok()) return impl_->failure;
  if (!is_cell(cell)) {
    return wrong_call(impl_->file, "the grid has no cell " + std::to_string(cell));
  }
  const std::string where = impl_->file.string() + ", " + cell_name(layer, cell);
  if (Status checked = check_frame(frame.size(), items, where); !checked) return checked;
  const Result<std::int64_t> frame_id = impl_->add_frame(frame);
  if (!frame_id) return impl_->keep(frame_id.error());
  return impl_->keep(impl_->insert(kInsertCell)
                         .bind(1, layer)
                         .bind(2, static_cast<std::int64_t>(cell))
                         .bind(3, static_cast<std::int64_t>(items))
                         .bind(4, static_cast<std::int64_t>(frame.size()))
                         .bind(5, digest_of(frame))
                         .bind(6, *frame_id)
                         .run());
}

Result<std::string> MapWriter::complete() {
  if (!impl_->failure.ok()) return impl_->failure.error();
  Result<std::string> build = impl_->complete();
  if (!build) return impl_->keep(build.error()).error();
  impl_->session.reset();
  return build;
}

Status MapWriter::publish() {
  if (!impl_->failure.ok()) return impl_->failure;
  return impl_->keep(publish_file(std::exchange(impl_->partial, {}), impl_->file));
}

Result<std::string> MapWriter::finish() {
  Result<std::string> build = complete();
  if (!build) return build;
  if (const Status published = publish(); !published.ok()) return published.error();
  return build;
}

}  // namespace milepost
