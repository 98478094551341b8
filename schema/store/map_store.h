// The map store: one SQLite file of segments and opaque tile bytes (map.sql, FORMAT.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "schema/base/bytes.h"
#include "schema/base/cell_grid.h"
#include "schema/base/ids.h"
#include "schema/base/range.h"
#include "schema/base/result.h"
#include "schema/document/manifest.h"
#include "schema/document/stored_map.h"
#include "schema/store/held_file.h"

namespace milepost {
namespace sqlite {
class Database;
}

// Reads one map. Opens the file read only and never changes it; a map file is replaced by renaming,
// so an open reader keeps reading the build that it opened. Whatever is returned has been checked
// against the build: the manifest when the map is opened, a segment when it is first read (the
// latest are kept), a tile at every reading.
// Not safe to use from several threads at once: open one reader per thread.
class MapReader {
 public:
  // Errors: not_found, corrupt (not a milepost map, one of another format version, or damaged), io.
  static Result<MapReader> open(const std::filesystem::path& file);
  // REQUIRES: the file outlives the reader. Errors: corrupt, io.
  static Result<MapReader> open(const HeldFile& file);

  MapReader(MapReader&&) noexcept;
  MapReader& operator=(MapReader&&) noexcept;
  ~MapReader();

  const std::filesystem::path& file() const;
  const std::string& build() const;         // digest of the manifest
  const std::string& feature_json() const;  // the feature parameters, a JSON object
  const Bounds& bounds() const;
  const std::string& datum() const;  // of all positions, Datum::text; empty: not stated
  const std::map<std::string, std::string>& layers() const;  // name -> parameters, a JSON object
  const std::vector<std::string>& segment_ids() const;       // in the order of the ids
  // Documents that the build covers (FORMAT.md 7), and their digests.
  const Manifest& manifest() const;
  const std::string& manifest_document() const;
  const std::string& map_document() const;

  // Errors of all below: not_found (segment, layer or tile), corrupt, io.
  Result<StoredSegment> segment(const std::string& id) const;
  Result<std::string> segment_document(const std::string& id) const;
  // The index of every tile of the layer, ascending.
  Result<std::vector<TileEntry>> tile_index(const std::string& segment,
                                            const std::string& layer) const;
  // The tiles whose range intersects the closed range `range`, ascending: all that have an item
  // there, and possibly one with a gap between its items there. REQUIRES: no NaN in `range`.
  Result<std::vector<TileEntry>> tiles_in(const std::string& segment, const std::string& layer,
                                          const AlongRange& range) const;
  // One encoded tile, as stored in the file.
  Result<Bytes> tile(const std::string& segment, const std::string& layer,
                     std::uint32_t index) const;
  // The same for an entry of the tile index.
  Result<Bytes> tile(const std::string& segment, const std::string& layer,
                     const TileEntry& entry) const;
  Result<std::string> areas_document() const;    // the index of the cells
  Result<std::string> mapping_document() const;  // of mapping_record.h; empty: none
  // The index of every cell of the layer, ascending; empty for a layer of segments.
  Result<std::vector<CellEntry>> cell_index(const std::string& layer) const;
  // The cells of the index that intersect the box, ascending.
  Result<std::vector<CellEntry>> cells_in(const std::string& layer, const Bounds& box) const;
  // The encoded tile of one cell, as stored in the file.
  Result<Bytes> cell(const std::string& layer, std::uint32_t number) const;
  Result<Bytes> cell(const std::string& layer, const CellEntry& entry) const;
  // Reads every byte: SQLite's integrity check, every tile's and cell's digest, every document.
  // Errors: corrupt, io.
  Status verify() const;

 private:
  struct Impl;
  explicit MapReader(std::unique_ptr<Impl> impl);
  static Result<MapReader> of(Result<sqlite::Database> database);
  std::unique_ptr<Impl> impl_;
};

// Writes one map. The file appears complete, when finish() is called, or not at all.
// The same calls give the same bytes. Not safe to use from several threads at once.
class MapWriter {
 public:
  // Errors: io (no such folder, no permission, disk full); invalid_input for an existing file that
  // is not a map, which is not replaced.
  // REQUIRES: no other writer of this process writes the same file.
  static Result<MapWriter> create(const std::filesystem::path& file);

  MapWriter(MapWriter&&) noexcept;
  MapWriter& operator=(MapWriter&&) noexcept;
  ~MapWriter();  // without finish(): removes what was written

  // Errors of all below: io (disk full); invalid_input for an id, a name or a number that cannot
  // be stored. After an error of SQLite every call returns that error.
  Status set_feature_json(const std::string& json);      // "{}" if not called
  Status set_datum(const std::string& datum);            // Datum::text
  Status set_mapping_document(const std::string& text);  // as mapping_document() writes it
  Status add_layer(const std::string& name, const std::string& parameters_json);
  Status add_segment(const StoredSegment& segment);
  // Replaces what was added with the segment. REQUIRES: it was added.
  Status set_position_error(const std::string& segment, const PositionError& error);
  // REQUIRES: the segment and the layer were added, (segment, layer, index) is new.
  Status add_tile(const std::string& segment, const std::string& layer, std::uint32_t index,
                  const AlongRange& along, std::uint64_t items, ByteView frame);
  // REQUIRES: the layer was added, (layer, cell) is new.
  Status add_cell(const std::string& layer, std::uint32_t cell, std::uint64_t items,
                  ByteView frame);
  // Computes the build, publishes the file and returns the build. Nothing may be added after it.
  Result<std::string> finish();
  // The same in two steps, for maps that belong together: all are completed before the first is
  // published. REQUIRES for publish(): complete() has returned a build.
  Result<std::string> complete();
  Status publish();

 private:
  struct Impl;
  explicit MapWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost
