#include "server/catalog/catalog.h"

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "server/catalog/map_file.h"
#include "server/catalog/signature_file.h"

namespace milepost::server {
namespace fs = std::filesystem;
namespace {

// The entries of a directory that are not hidden, sorted by name.
Result<std::vector<fs::path>> files_of(const fs::path& directory) {
  std::error_code error;
  std::vector<fs::path> files;
  fs::directory_iterator entry(directory, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const bool hidden = entry->path().filename().string().starts_with('.');
    if (!hidden) files.push_back(entry->path());
  }
  if (error == std::errc::no_such_file_or_directory) {
    return Error{ErrorCode::not_found, directory.string(), "there is no such directory",
                 "give the directory of the map files"};
  }
  if (error) {
    return Error{ErrorCode::io, directory.string(), "cannot be listed (" + error.message() + ")",
                 "give a readable directory of map files"};
  }
  std::sort(files.begin(), files.end());
  return files;
}

Document catalog_document(const std::map<std::string, std::shared_ptr<const ServedMap>>& maps) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& [name, map] : maps) list.push_back({{"name", name}, {"build", map->build()}});
  const nlohmann::ordered_json json = {{"maps", std::move(list)}};
  return document_of(json.dump());
}

// A file that is, or by its name should be, a map.
struct Candidate {
  fs::path file;
  Status content;  // check_map_file
};

// The file to serve among several of one map name, or null if that is ambiguous.
const Candidate* chosen_of(const std::vector<Candidate>& same_name) {
  if (same_name.size() == 1) return &same_name.front();
  const auto found = std::ranges::find_if(
      same_name, [](const Candidate& candidate) { return candidate.file.extension() == ".map"; });
  return found == same_name.end() ? nullptr : &*found;
}

Error same_name_error(const std::string& name, const fs::path& file, const fs::path& other) {
  return {ErrorCode::invalid_input, file.string(),
          "has the same map name '" + name + "' as " + other.string(),
          "rename or remove one of the two"};
}

// Finds the maps among files and opens them.
class Opening {
 public:
  Opening(unsigned readers, const Catalog::Warn& warn) : readers_(readers), warn_(warn) {}

  void look_at(const fs::path& file) {
    if (is_named_as_signature(file)) return;
    const Status content = check_map_file(file);
    if (!content && content.error().code == ErrorCode::invalid_input && !is_named_as_map(file)) {
      warn_(content.error().line());
      return;
    }
    const Result<std::string> name = map_name_of(file);
    if (name) {
      candidates_[*name].push_back({file, content});
    } else {
      left_out.push_back(content ? name.error() : content.error());
    }
  }

  void open_maps() {
    for (const auto& [name, same_name] : candidates_) {
      const Candidate* chosen = chosen_of(same_name);
      for (const Candidate& candidate : same_name) {
        const Status opened = &candidate == chosen ? open_map(name, candidate)
                                                   : refused(name, candidate, same_name, chosen);
        if (!opened) left_out.push_back(opened.error());
      }
    }
  }

  std::map<std::string, std::shared_ptr<const ServedMap>> maps;
  std::vector<Error> left_out;

 private:
  Status open_map(const std::string& name, const Candidate& candidate) {
    if (!candidate.content) return candidate.content;
    Result<std::shared_ptr<const ServedMap>> map = ServedMap::open(name, candidate.file, readers_);
    if (!map) return map.error();
    maps[name] = std::move(*map);
    return ok_status();
  }

  // The error of a file that is not served because of others with the same map name.
  static Status refused(const std::string& name, const Candidate& candidate,
                        const std::vector<Candidate>& same_name, const Candidate* chosen) {
    if (!candidate.content) return candidate.content;
    if (chosen == nullptr) chosen = &same_name[&candidate == &same_name.front() ? 1 : 0];
    return same_name_error(name, candidate.file, chosen->file);
  }

  unsigned readers_;
  const Catalog::Warn& warn_;
  std::map<std::string, std::vector<Candidate>> candidates_;
};

}  // namespace

Result<std::shared_ptr<const Catalog>> Catalog::open(const fs::path& directory, unsigned readers,
                                                     const Warn& warn) {
  const Result<std::vector<fs::path>> files = files_of(directory);
  if (!files) return files.error();
  Opening opening(readers, warn);
  for (const fs::path& file : *files) opening.look_at(file);
  opening.open_maps();
  const std::vector<Error>& left_out = opening.left_out;
  if (opening.maps.empty() && left_out.size() == 1) return left_out.front();
  for (const Error& error : left_out) warn(error.line());
  if (opening.maps.empty() && !left_out.empty()) {
    return Error{ErrorCode::corrupt, directory.string(),
                 "none of its " + std::to_string(left_out.size()) + " maps can be served",
                 "see the lines before this one"};
  }
  const std::shared_ptr<Catalog> catalog(new Catalog);
  catalog->maps_ = std::move(opening.maps);
  catalog->left_out_ = left_out.size();
  catalog->document_ = catalog_document(catalog->maps_);
  return std::shared_ptr<const Catalog>(catalog);
}

}  // namespace milepost::server
