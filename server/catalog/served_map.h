// One map that is served: lines, documents and indices in memory, tiles on the disk.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "schema/geo/near.h"
#include "schema/store/map_store.h"
#include "server/catalog/document.h"
#include "server/catalog/reader_pool.h"

namespace milepost::server {

struct ServedSegment {
  double length_m = 0;  // as the map states it
  BoxedLine line;
  std::map<std::string, std::vector<TileEntry>> tiles;  // layer -> index, ascending; every layer
  Document document;
};

// Immutable, so safe to share between threads.
class ServedMap {
 public:
  // Opens `readers` readers, one for each thread that reads tiles.
  // Errors: those of MapReader.
  static Result<std::shared_ptr<const ServedMap>> open(const std::string& name,
                                                       const std::filesystem::path& file,
                                                       unsigned readers);

  const std::string& name() const { return name_; }
  const std::string& build() const { return build_; }
  const std::map<std::string, ServedSegment>& segments() const { return segments_; }
  // Layer -> index, ascending; every layer, also those without cells.
  const std::map<std::string, std::vector<CellEntry>>& cells() const { return cells_; }
  const Document& document() const { return document_; }  // of the current state
  const Document& manifest() const { return manifest_; }
  const Document& summary() const { return summary_; }  // the build's map document
  const Document& areas() const { return areas_; }      // the index of the cells
  const Bounds& box() const { return box_; }            // of all segments' lines

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
  Status load_segment(const MapReader& reader, const std::string& id);
  Status load_cells(const MapReader& reader);

  // Constant after construction.
  std::string name_;
  std::string build_;
  std::filesystem::path file_;
  std::map<std::string, std::string> layers_;
  std::map<std::string, ServedSegment> segments_;
  std::map<std::string, std::vector<CellEntry>> cells_;
  Bounds box_;
  Document document_;
  Document manifest_;
  Document summary_;
  Document areas_;
  std::unique_ptr<ReaderPool> readers_;  // synchronizes itself
};

}  // namespace milepost::server
