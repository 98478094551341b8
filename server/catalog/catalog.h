// The maps that are served at one time, for the handling of requests.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/catalog/map_directory.h"
#include "server/catalog/open_maps.h"

namespace milepost::server {

struct CatalogSettings {
  OpenMapLimits open_maps = {};
  KeptLimits kept = {};
  std::chrono::milliseconds keep{600'000};  // how long a build that was replaced stays
  bool all_must_be_served = false;          // /readyz is 503 while a map is left out
};

// A build that was current until a short time ago.
struct OldBuild {
  std::shared_ptr<const MapBuild> build;
  std::chrono::steady_clock::time_point until;
};

// The document of GET /v1/maps.
Document catalog_document(const std::map<std::string, std::shared_ptr<const MapBuild>>& maps);

// Immutable but for the maps in memory, which synchronize themselves: safe to share between
// threads.
class Catalog {
 public:
  using Clock = std::chrono::steady_clock;

  // Errors: those of read_directory; if there are maps and none can be served, the reason. Each
  // file that is left out, and each that is no map, is told to `warn`.
  static Result<std::shared_ptr<const Catalog>> open(const std::filesystem::path& directory,
                                                     const CatalogSettings& settings,
                                                     const Warn& warn);

  // The catalog of what the directory holds now. Builds that were replaced stay until their time is
  // over, and so does the build of a map whose new file cannot be served, for as long as that is
  // so. Where `changes` tells of all that happened since, no other files are looked at. `warn` is
  // told of what was not left out before. Errors: those of read_directory.
  Result<std::shared_ptr<const Catalog>> reloaded(Clock::time_point now, const Warn& warn,
                                                  const DirectoryChanges& changes) const;

  // The current builds, by the maps' names.
  const std::map<std::string, std::shared_ptr<const MapBuild>>& maps() const { return maps_; }
  const std::map<std::string, std::vector<OldBuild>>& old_builds() const { return old_; }
  const Document& document() const { return document_; }  // of GET /v1/maps
  // Files that hold a map, or are named ".map", but are not served.
  std::size_t left_out() const { return directory_.left_out.size(); }
  const std::vector<std::pair<std::filesystem::path, Error>>& left_out_files() const {
    return directory_.left_out;
  }
  const CatalogSettings& settings() const { return settings_; }
  // When the first old build's time is over.
  std::optional<Clock::time_point> next_change() const;

  // The current build, or an old one. Null: there is none.
  std::shared_ptr<const MapBuild> build(const std::string& map, const std::string& build) const;
  // One that kept_builds.h tells the place of. Null: there is none.
  std::shared_ptr<const MapBuild> older_build(const std::string& map,
                                              const std::string& build) const;
  // Current builds whose segments may pass within the radius.
  std::vector<std::shared_ptr<const MapBuild>> near(const GeoPoint& position,
                                                    double radius_m) const;
  // Blocks while the map is read from its file. Errors: those of OpenMaps::map.
  Result<std::shared_ptr<const ServedMap>> read(const MapBuild& build) const {
    return open_maps_->map(build);
  }
  // The same for its lines alone, most of which are in memory.
  Result<std::shared_ptr<const MapLines>> lines(const MapBuild& build) const;
  // The text of the signature of a build that is served. Errors: those of Signatures::of.
  Result<std::string> signature(const ServedMap& map) const;
  // Maps whose files were damaged after they were opened.
  std::map<std::pair<std::string, std::string>, Error> faults() const {
    return open_maps_->faults()->all();
  }
  // Whether both were read from the same files, and have the same old builds.
  bool is_same(const Catalog& other) const;

 private:
  Catalog() = default;
  void take(MapDirectory directory, const Catalog* before, Clock::time_point now);
  void retire(const Catalog& before, Clock::time_point now);
  void index();

  std::filesystem::path path_;
  CatalogSettings settings_;
  std::shared_ptr<OpenMaps> open_maps_;
  MapDirectory directory_;
  std::map<std::string, std::shared_ptr<const MapBuild>> maps_;
  std::map<std::string, std::vector<OldBuild>> old_;
  std::vector<std::shared_ptr<const MapBuild>> with_lines_;
  std::optional<BoxTree> tree_;  // of with_lines_
  Document document_;
};

}  // namespace milepost::server
