#include "server/catalog/catalog.h"

#include <algorithm>

#include "schema/store/sqlite.h"
#include "server/catalog/kept_builds.h"

namespace milepost::server {
namespace fs = std::filesystem;
namespace {

// Whether a file of the map is there, but cannot be served.
bool is_left_out(const MapDirectory& directory, const std::string& map) {
  return std::ranges::any_of(directory.left_out, [&](const auto& left_out) {
    const auto looked = directory.files.find(left_out.first.native());
    return looked != directory.files.end() && looked->second.name == map;
  });
}

}  // namespace

Document catalog_document(const std::map<std::string, std::shared_ptr<const MapBuild>>& maps) {
  std::string text = R"({"maps":[)";
  const char* separator = "";
  for (const auto& [name, map] : maps) {  // neither needs an escape
    text.append(separator).append(R"({"name":")").append(name);
    text.append(R"(","build":")").append(map->build).append("\"}");
    separator = ",";
  }
  return document_of(text.append("]}"));
}

Result<std::shared_ptr<const Catalog>> Catalog::open(const fs::path& directory,
                                                     const CatalogSettings& settings,
                                                     const Warn& warn) {
  sqlite::expect_many_connections();
  const std::shared_ptr<Catalog> catalog(new Catalog);
  catalog->path_ = directory;
  catalog->settings_ = settings;
  catalog->open_maps_ =
      std::make_shared<OpenMaps>(settings.open_maps, std::make_shared<MapFaults>());
  Result<MapDirectory> read =
      read_directory(directory, {}, {{}, true}, *catalog->open_maps_, settings.kept, warn);
  if (!read) return read.error();
  const auto& left_out = read->left_out;
  if (read->maps.empty() && left_out.size() == 1) return left_out.front().second;
  for (const auto& [file, error] : left_out) warn(error.line());
  if (read->maps.empty() && !left_out.empty()) {
    return Error{ErrorCode::corrupt, directory.string(),
                 "none of its " + std::to_string(left_out.size()) + " maps can be served",
                 "see the lines before this one"};
  }
  catalog->take(std::move(*read), nullptr, Clock::now());
  return std::shared_ptr<const Catalog>(catalog);
}

Result<std::shared_ptr<const Catalog>> Catalog::reloaded(Clock::time_point now, const Warn& warn,
                                                         const DirectoryChanges& changes) const {
  Result<MapDirectory> read =
      read_directory(path_, directory_, changes, *open_maps_, settings_.kept, warn);
  if (!read) return read.error();
  const auto is_known = [&](const std::pair<fs::path, Error>& left_out) {
    return std::ranges::any_of(directory_.left_out, [&](const auto& known) {
      return known.first == left_out.first && known.second.line() == left_out.second.line();
    });
  };
  for (const auto& left_out : read->left_out) {
    if (!is_known(left_out)) warn(left_out.second.line());
  }
  const std::shared_ptr<Catalog> catalog(new Catalog);
  catalog->path_ = path_;
  catalog->settings_ = settings_;
  catalog->open_maps_ = open_maps_;
  catalog->take(std::move(*read), this, now);
  return std::shared_ptr<const Catalog>(catalog);
}

void Catalog::take(MapDirectory directory, const Catalog* before, Clock::time_point now) {
  directory_ = std::move(directory);
  maps_ = directory_.maps;
  if (before != nullptr) retire(*before, now);
  const auto is_served = [this](const std::string& map, const std::string& build) {
    return this->build(map, build) != nullptr;
  };
  open_maps_->faults()->keep_only(is_served);
  open_maps_->signatures().keep_only(is_served);
  index();
  document_ = catalog_document(maps_);
}

void Catalog::retire(const Catalog& before, Clock::time_point now) {
  const auto faults = open_maps_->faults()->all();
  auto current = maps_.begin();
  for (const auto& [name, build] : before.maps_) {  // both in the order of the names
    while (current != maps_.end() && current->first < name) ++current;
    const bool is_there = current != maps_.end() && current->first == name;
    if (is_there && current->second == build) continue;
    if (!is_there && is_left_out(directory_, name)) {
      maps_.emplace_hint(current, name, build);
      continue;
    }
    const bool is_gone = !is_there || current->second->build != build->build;
    // What was written over, or is damaged, cannot be read any more.
    const bool is_damaged = faults.contains({name, build->build});
    const bool is_overwritten = is_there && current->second->identity.is_same_file(build->identity);
    if (is_gone && !is_overwritten && !is_damaged)
      old_[name].push_back({build, now + settings_.keep});
  }
  for (const auto& [name, builds] : before.old_) {
    const auto known = maps_.find(name);
    for (const OldBuild& old : builds) {
      const bool is_current = known != maps_.end() && known->second->build == old.build->build;
      if (!is_current && old.until > now) old_[name].push_back(old);
    }
  }
  std::erase_if(old_, [](const auto& map) { return map.second.empty(); });
}

bool Catalog::is_same(const Catalog& other) const {
  const auto same_file = [](const auto& a, const auto& b) {
    return a.first == b.first && a.second.identity == b.second.identity;
  };
  const auto same_old = [](const auto& a, const auto& b) {
    return a.first == b.first && a.second.size() == b.second.size();
  };
  return maps_ == other.maps_ &&
         std::ranges::equal(directory_.files, other.directory_.files, same_file) &&
         std::ranges::equal(old_, other.old_, same_old);
}

void Catalog::index() {
  std::vector<Bounds> boxes;
  for (const auto& [name, build] : maps_) {
    if (!build->bounds) continue;
    with_lines_.push_back(build);
    boxes.push_back(*build->bounds);
  }
  tree_.emplace(boxes);
}

std::optional<Catalog::Clock::time_point> Catalog::next_change() const {
  std::optional<Clock::time_point> first;
  for (const auto& [name, builds] : old_) {
    for (const OldBuild& old : builds) first = std::min(first.value_or(old.until), old.until);
  }
  return first;
}

std::shared_ptr<const MapBuild> Catalog::build(const std::string& map,
                                               const std::string& build) const {
  const auto current = maps_.find(map);
  if (current != maps_.end() && current->second->build == build) return current->second;
  const auto old = old_.find(map);
  if (old == old_.end()) return nullptr;
  const auto found = std::ranges::find_if(
      old->second, [&](const OldBuild& each) { return each.build->build == build; });
  return found == old->second.end() ? nullptr : found->build;
}

std::shared_ptr<const MapBuild> Catalog::older_build(const std::string& map,
                                                     const std::string& build) const {
  const fs::path file = kept_build_file(path_, map, build);
  const Result<FileIdentity> identity = identity_of(file);
  if (!identity) return nullptr;
  return std::make_shared<const MapBuild>(
      MapBuild{map, build, std::nullopt, nullptr, file, *identity, nullptr});
}

Result<std::string> Catalog::signature(const ServedMap& map) const {
  const auto current = maps_.find(map.name());
  return open_maps_->signatures().of(
      {map.name(), map.build(), map.file(), kept_build_file(path_, map.name(), map.build()),
       current != maps_.end() && current->second->build == map.build()});
}

Result<std::shared_ptr<const MapLines>> Catalog::lines(const MapBuild& build) const {
  if (build.lines) return build.lines;
  const auto map = read(build);
  if (!map) return map.error();
  return (*map)->lines();
}

std::vector<std::shared_ptr<const MapBuild>> Catalog::near(const GeoPoint& position,
                                                           double radius_m) const {
  std::vector<std::shared_ptr<const MapBuild>> found;
  for (const std::size_t number : tree_->near(position, radius_m))
    found.push_back(with_lines_[number]);
  return found;
}

}  // namespace milepost::server
