// One map that is served: lines, documents and indices in memory, tiles on the disk.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "schema/store/map_store.h"
#include "server/catalog/document.h"
#include "server/catalog/map_faults.h"
#include "server/catalog/map_lines.h"
#include "server/catalog/reader_pool.h"

namespace milepost::server {

struct ServedSegment {
  std::map<std::string, std::vector<TileEntry>> tiles;  // layer -> index, ascending; every layer
  Document document;
};

// Safe to share between threads: nothing that is seen of it changes.
class ServedMap {
 public:
  // Has up to `readers` readers, for threads that read tiles at once. Tells `faults` of tiles that
  // cannot be read. Errors: those of MapReader.
  static Result<std::shared_ptr<const ServedMap>> open(const std::string& name,
                                                       std::shared_ptr<const HeldFile> file,
                                                       unsigned readers,
                                                       std::shared_ptr<MapFaults> faults);

  const std::string& name() const { return name_; }
  const std::string& build() const { return build_; }
  const std::filesystem::path& file() const { return file_->path(); }  // where it was opened
  const std::map<std::string, ServedSegment>& segments() const { return segments_; }
  // Layer -> index, ascending; every layer, also those without cells.
  const std::map<std::string, std::vector<CellEntry>>& cells() const { return cells_; }
  const Document& document() const;  // of the current state
  const Document& manifest() const { return manifest_; }
  const Document& summary() const { return summary_; }  // the build's map document
  const Document& areas() const { return areas_; }      // the index of the cells
  const std::shared_ptr<const MapLines>& lines() const { return lines_; }
  // Of the documents and the indices, about.
  std::uint64_t memory_bytes() const { return memory_bytes_; }

  // An encoded tile, checked against its entry in the index.
  // Errors: corrupt (it is not the one of the index), io.
  Result<Bytes> tile(const std::string& segment, const std::string& layer,
                     const TileEntry& entry) const;
  // The same for a cell.
  Result<Bytes> cell(const std::string& layer, const CellEntry& entry) const;
  // The record of the mapping, read at each call; empty if the map has none.
  // Errors: corrupt, io.
  Result<std::string> mapping() const;

 private:
  ServedMap() = default;
  Status load(const MapReader& reader);
  Result<SegmentLine> load_segment(const MapReader& reader, const std::string& id);
  Status load_cells(const MapReader& reader);
  void count_memory();
  Result<Bytes> checked(Result<Bytes> tile, std::uint64_t bytes, const std::string& where) const;

  // Constant after construction.
  std::string name_;
  std::string build_;
  std::shared_ptr<const HeldFile> file_;
  std::map<std::string, std::string> layers_;
  std::map<std::string, ServedSegment> segments_;
  std::map<std::string, std::vector<CellEntry>> cells_;
  std::shared_ptr<const MapLines> lines_;
  std::uint64_t memory_bytes_ = 0;
  mutable std::once_flag document_asked_for_;
  mutable Document document_;  // guarded by document_asked_for_
  Document manifest_;
  Document summary_;
  Document areas_;
  std::unique_ptr<ReaderPool> readers_;  // synchronizes itself, as do the faults
  std::shared_ptr<MapFaults> faults_;
};

}  // namespace milepost::server
