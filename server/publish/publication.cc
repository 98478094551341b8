#include "server/publish/publication.h"

#include <map>
#include <system_error>
#include <utility>
#include <vector>

#include "schema/base/digest.h"
#include "schema/base/file.h"
#include "schema/base/ids.h"
#include "schema/base/json.h"
#include "server/publish/published_headers.h"
#include "server/publish/static_catalog.h"
#include "server/publish/static_tree.h"
#include "server/routes/handle.h"

namespace milepost::server {
namespace fs = std::filesystem;
namespace {

using nlohmann::json;

// A document whose URL is also the start of others is stored under this name in their folder.
constexpr const char* kIndex = "index.json";

std::string below(const std::string& path, const std::string& name) { return path + '/' + name; }

// The error that the server would report.
Error error_of(const Response& response, const std::string& target) {
  const auto* body = std::get_if<SharedText>(&response.body);
  const json problem = json::parse(body && *body ? **body : "", nullptr, false);
  const std::string detail =
      problem.is_object() ? problem.value("detail", std::string()) : std::string();
  const ErrorCode code = response.status == 404 ? ErrorCode::not_found : ErrorCode::corrupt;
  return {code, "", detail.empty() ? "cannot read " + target : detail, ""};
}

Result<std::string> body_of(const Response& response) {
  if (const auto* text = std::get_if<SharedText>(&response.body)) return **text;
  std::string body;
  const auto append = [&body](const Result<Bytes>& tile) {
    if (tile) body += as_text(*tile);
    return tile ? ok_status() : Status(tile.error());
  };
  if (const auto* list = std::get_if<TileList>(&response.body)) {
    for (const TileEntry* entry : list->tiles) {
      const Status read = append(list->map->tile(list->segment, list->layer, *entry));
      if (!read) return read.error();
    }
    return body;
  }
  const auto& list = std::get<CellList>(response.body);
  for (const CellEntry* entry : list.cells) {
    const Status read = append(list.map->cell(list.layer, *entry));
    if (!read) return read.error();
  }
  return body;
}

class Publication {
 public:
  Publication(const Catalog& catalog, const PublishSettings& settings, StaticTree& tree,
              EntityTags before)
      : catalog_(catalog), settings_(settings), tree_(tree), before_(std::move(before)) {}

  Status write_all() {
    const Result<std::string> maps = get("/v1/maps");
    if (!maps) return maps.error();
    std::vector<std::pair<std::string, std::string>> current;  // path, content: written last
    const json catalog = json::parse(*maps);
    for (const json& map : catalog.at("maps")) {
      const auto name = map.at("name").get<std::string>();
      Result<std::string> document = get("/v1/maps/" + name);
      if (!document) return document.error();
      const Status written = write_build(name, json::parse(*document));
      if (!written) return written;
      current.emplace_back("v1/maps/" + name + "/" + kIndex, std::move(*document));
    }
    current.emplace_back("v1/segments", static_segments_document(placed_));
    current.emplace_back(std::string("v1/maps/") + kIndex, static_maps_document(*maps));
    return write_current(current);
  }

  Status remove_old() {
    for (const std::string& map : tree_.names_in("v1/maps")) {
      if (!is_segment_id(map)) continue;
      const Status removed = remove_old_of(map);
      if (!removed) return removed;
    }
    return ok_status();
  }

  PublishCounts counts() const { return {tree_.files(), tree_.written(), removed_}; }

 private:
  Result<std::string> get(const std::string& target) const {
    const Response response = handle({"GET", target, ""}, catalog_);
    if (response.status != 200) return error_of(response, target);
    return body_of(response);
  }

  // Writes what the server answers at `target`, an absolute path, and returns it.
  Result<std::string> copy(const std::string& target, const std::string& file) {
    if (settings_.stopped()) {
      return Error{ErrorCode::cancelled, tree_.folder().string(), "stopped on request",
                   "run it again to publish the rest"};
    }
    Result<std::string> content = get(target);
    if (!content) return content;
    const Status written = write(file, *content);
    if (!written) return written.error();
    return content;
  }
  Result<std::string> copy(const std::string& target) { return copy(target, target.substr(1)); }

  Status write(const std::string& path, const std::string& content) {
    tags_[path] = digest_of(as_bytes(content));
    return tree_.write(path, content);
  }

  static Status check_name(const std::string& kind, const std::string& name) {
    if (name != kIndex) return ok_status();
    return Error{ErrorCode::invalid_input, kind + " '" + name + "'",
                 "has the name that a published tree uses for its documents", "rename it"};
  }

  Status write_build(const std::string& map, const json& document) {
    const Status named = check_name("map", map);
    if (!named) return named;
    const auto build = document.at("build").get<std::string>();
    current_builds_.emplace(map, build);
    const std::string root = "/v1/maps/" + map + "/builds/" + build;
    const auto& segments = document.at("segments");
    for (std::size_t i = 0; i < segments.size(); ++i) {
      settings_.on_progress("map " + map + ": segment " + std::to_string(i + 1) + " of " +
                            std::to_string(segments.size()));
      const auto id = segments[i].get<std::string>();
      const Status written = write_segment(root, {map, build, id, {}});
      if (!written) return written;
    }
    const Status areas = write_areas(root);
    if (!areas) return areas;
    // A build need be neither signed nor recorded.
    for (const char* name : {"/mapping", "/manifest.sig"}) {
      const Status copied = copy_if_any(root + name);
      if (!copied) return copied;
    }
    for (const char* name : {"/map", "/manifest"}) {
      const Result<std::string> copied = copy(root + name);
      if (!copied) return copied.error();
    }
    return ok_status();
  }

  Status write_segment(const std::string& root, PlacedSegment placed) {
    const std::string target = root + "/segments/" + placed.segment;
    const Result<std::string> text = get(target);
    if (!text) return text.error();
    const Result<Bounds> bounds = bounds_of_segment(*text, target);
    if (!bounds) return bounds.error();
    placed.bounds = *bounds;
    placed_.push_back(std::move(placed));
    const json document = json::parse(*text);
    for (const auto& [layer, index] : document.at("tiles").items()) {
      for (const json& tile : index) {
        const Result<std::string> copied =
            copy(below(below(target + "/tiles", layer), tile.at("index").dump()));
        if (!copied) return copied.error();
      }
    }
    return write(target.substr(1) + "/" + kIndex, *text);
  }

  Status write_areas(const std::string& root) {
    const std::string target = root + "/areas";
    const Result<std::string> text = get(target);
    if (!text) return text.error();
    const json document = json::parse(*text);
    for (const auto& [layer, index] : document.at("cells").items()) {
      const Status named = check_name("layer", layer);
      if (!named) return named;
      settings_.on_progress("layer " + layer + ": " + std::to_string(index.size()) + " cells");
      for (const json& cell : index) {
        const Result<std::string> copied =
            copy(below(below(target, layer), cell.at("cell").dump()));
        if (!copied) return copied.error();
      }
    }
    return write(target.substr(1) + "/" + kIndex, *text);
  }

  // Writes nothing where the server has nothing.
  Status copy_if_any(const std::string& target) {
    const Result<std::string> copied = copy(target);
    if (copied || copied.error().code == ErrorCode::not_found) return ok_status();
    return copied.error();
  }

  // What other documents lead to is on the disk before they are written.
  Status write_current(const std::vector<std::pair<std::string, std::string>>& documents) {
    const Status synced = tree_.sync();
    if (!synced) return synced;
    for (const auto& [path, content] : documents) tags_[path] = digest_of(as_bytes(content));
    const Status listed = tree_.write(StaticTree::kHeadersFile, headers_document(all_tags()));
    if (!listed) return listed;
    for (const auto& [path, content] : documents) {
      const Status written = write(path, content);
      if (!written) return written;
    }
    return tree_.sync();
  }

  // With those of older builds that stay.
  EntityTags all_tags() const {
    EntityTags tags = tags_;
    std::error_code ignored;
    for (const auto& [path, tag] : before_) {
      if (!settings_.remove_old && fs::is_regular_file(tree_.folder() / path, ignored)) {
        tags.emplace(path, tag);
      }
    }
    return tags;
  }

  // Removes builds of a map that are not current, and the map if it has no current one.
  Status remove_old_of(const std::string& map) {
    const std::string folder = "v1/maps/" + map;
    const std::vector<std::string> builds = tree_.names_in(folder + "/builds");
    const auto current = current_builds_.find(map);
    const bool is_gone = current == current_builds_.end();
    if (is_gone && builds.empty()) return ok_status();
    if (is_gone) {
      const Status removed = tree_.remove(folder + "/" + kIndex);
      if (!removed) return removed;
    }
    for (const std::string& build : builds) {
      if (!is_digest(build) || (!is_gone && current->second == build)) continue;
      const Status removed = tree_.remove(below(folder + "/builds", build));
      if (!removed) return removed;
      ++removed_;
    }
    if (is_gone) {  // the folders too, unless something else is in them
      std::error_code ignored;
      fs::remove(tree_.folder() / folder / "builds", ignored);
      fs::remove(tree_.folder() / folder, ignored);
    }
    return ok_status();
  }

  const Catalog& catalog_;
  const PublishSettings& settings_;
  StaticTree& tree_;
  const EntityTags before_;  // of the tree when it was opened
  EntityTags tags_;
  std::vector<PlacedSegment> placed_;
  std::map<std::string, std::string> current_builds_;  // by map
  std::size_t removed_ = 0;
};

Result<EntityTags> tags_of(const StaticTree& tree) {
  const fs::path file = tree.folder() / StaticTree::kHeadersFile;
  const Result<std::string> text = read_text_file(file);
  if (!text) return text.error();
  Result<EntityTags> tags = entity_tags_in(*text);
  if (tags) return tags;
  Error error = tags.error();
  error.where = file.string();
  return error;
}

}  // namespace

Result<PublishCounts> publish(const Catalog& catalog, const PublishSettings& settings) {
  Result<StaticTree> tree = StaticTree::open(settings.folder, headers_document({}));
  if (!tree) return tree.error();
  Result<EntityTags> before = tags_of(*tree);
  if (!before) return before.error();
  Publication publication(catalog, settings, *tree, std::move(*before));
  const Status written = publication.write_all();
  if (!written) return written.error();
  if (settings.remove_old) {
    const Status removed = publication.remove_old();
    if (!removed) return removed.error();
  }
  return publication.counts();
}

}  // namespace milepost::server
