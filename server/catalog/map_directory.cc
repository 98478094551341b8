#include "server/catalog/map_directory.h"

#include <algorithm>
#include <atomic>
#include <system_error>
#include <thread>
#include <utility>

#include "server/catalog/map_file.h"
#include "server/catalog/signature_file.h"

namespace milepost::server {
namespace fs = std::filesystem;
namespace {

constexpr unsigned kMaxScanners = 8;

bool may_be_map(const fs::path& file) {
  return !file.filename().string().starts_with('.') && !is_named_as_signature(file);
}

// The entries of a directory that are not hidden and no signatures, sorted by name.
Result<std::vector<fs::path>> files_of(const fs::path& directory) {
  std::error_code error;
  std::vector<fs::path> files;
  fs::directory_iterator entry(directory, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    if (may_be_map(entry->path())) files.push_back(entry->path());
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

Error same_name_error(const std::string& name, const fs::path& file, const fs::path& other) {
  return {ErrorCode::invalid_input, file.string(),
          "has the same map name '" + name + "' as " + other.string(),
          "rename or remove one of the two"};
}

// Files with the same map name, by path.
using File = std::pair<const std::string, LookedAt>;
using SameName = std::vector<File*>;

// The one that is served, or null if that is ambiguous.
File* chosen_of(const SameName& files) {
  if (files.size() == 1) return files.front();
  const auto found =
      std::ranges::find_if(files, [](const File* file) { return file->first.ends_with(".map"); });
  return found == files.end() ? nullptr : *found;
}

class Scan {
 public:
  Scan(const MapDirectory& before, OpenMaps& open_maps, const KeptLimits& limits, const Warn& warn)
      : before_(before), open_maps_(open_maps), limits_(limits), warn_(warn) {}

  void look_at(const fs::path& file) {
    const Result<FileIdentity> identity = identity_of(file);
    const auto known = before_.files.find(file.native());
    if (identity && known != before_.files.end() && known->second.identity == *identity) {
      found_.files[file.native()] = known->second;
    } else {
      found_.files[file.native()] = first_look(file, identity ? *identity : FileIdentity());
    }
  }

  // At these only; the others are as they were.
  void look_again_at(const std::set<fs::path>& files) {
    found_.files = before_.files;
    for (const fs::path& file : files) {
      if (is_named_as_signature(file)) see_signature_of(fs::path(file).replace_extension());
      if (!may_be_map(file)) continue;
      found_.files.erase(file.native());
      std::error_code ignored;
      if (fs::symlink_status(file, ignored).type() != fs::file_type::not_found) look_at(file);
    }
  }

  // Of each name the one file that is served.
  void read_maps() {
    for (File& file : found_.files) {
      const LookedAt& looked = file.second;
      if (!looked.name.empty()) {  // mostly in the order of the paths
        candidates_.try_emplace(candidates_.end(), looked.name)->second.push_back(&file);
      } else if (!looked.is_no_map) {
        found_.left_out.emplace_back(file.first, *looked.fault);
      }
    }
    std::vector<File*> to_read;
    for (const auto& [name, files] : candidates_) {
      File* const chosen = chosen_of(files);
      if (chosen != nullptr && !chosen->second.build && !chosen->second.fault)
        to_read.push_back(chosen);
    }
    read(to_read);
  }

  MapDirectory result() {
    for (const auto& [name, files] : candidates_) {
      const File* const chosen = chosen_of(files);
      for (const File* file : files) {
        const LookedAt& looked = file->second;
        if (file == chosen && looked.build) {
          found_.maps.emplace_hint(found_.maps.end(), name, looked.build);
        } else if (looked.fault) {
          found_.left_out.emplace_back(file->first, *looked.fault);
        } else {
          const File* const other =
              chosen != nullptr ? chosen : files[file == files.front() ? 1 : 0];
          found_.left_out.emplace_back(file->first,
                                       same_name_error(name, file->first, other->first));
        }
      }
    }
    return std::move(found_);
  }

 private:
  void see_signature_of(const fs::path& file) {
    const auto known = before_.files.find(file.native());
    if (known == before_.files.end() || !known->second.build) return;
    open_maps_.signatures().see(known->second.name, known->second.build->build, file);
  }

  LookedAt first_look(const fs::path& file, const FileIdentity& identity) const {
    LookedAt looked{identity, false, {}, nullptr, {}};
    const Status content = check_map_file(file);
    if (!content) looked.fault = content.error();
    looked.is_no_map =
        !content && content.error().code == ErrorCode::invalid_input && !is_named_as_map(file);
    if (looked.is_no_map) {
      warn_(looked.fault->line());
      return looked;
    }
    const Result<std::string> name = map_name_of(file);
    if (name) looked.name = *name;
    if (!name && content) looked.fault = name.error();
    return looked;
  }

  void read(const std::vector<File*>& files) {
    if (files.empty()) return;
    for (const auto& [name, build] : before_.maps) {
      held_ += build->held ? 1 : 0;
      line_bytes_ += build->lines ? build->lines->memory_bytes() : 0;
    }
    std::atomic<std::size_t> next{0};
    const auto read_some = [&] {
      for (std::size_t i = next++; i < files.size(); i = next++)
        read(files[i]->first, files[i]->second);
    };
    const auto most = std::min<std::size_t>(
        files.size(), std::clamp(std::thread::hardware_concurrency(), 1U, kMaxScanners));
    std::vector<std::thread> others;
    for (std::size_t i = 1; i < most; ++i) others.emplace_back(read_some);
    read_some();
    for (std::thread& thread : others) thread.join();
  }

  // Changes nothing but `looked`, the file's own entry.
  void read(const fs::path& file, LookedAt& looked) {
    Result<HeldFile> opened = HeldFile::open(file);
    if (!opened) {
      looked.fault = opened.error();
      return;
    }
    const auto held = std::make_shared<const HeldFile>(std::move(*opened));
    looked.identity = held->identity();
    const auto map =
        ServedMap::open(looked.name, held, open_maps_.limits().readers, open_maps_.faults());
    if (!map) {
      looked.fault = map.error();
      return;
    }
    const bool stays_open = held_++ < limits_.held_files;
    const std::shared_ptr<const MapLines>& lines = (*map)->lines();
    line_bytes_ += lines->memory_bytes();
    const bool stays_in_memory = line_bytes_ <= limits_.line_bytes;
    looked.build = std::make_shared<const MapBuild>(
        MapBuild{looked.name, (*map)->build(), lines->bounds(), stays_in_memory ? lines : nullptr,
                 file, held->identity(), stays_open ? held : nullptr});
    open_maps_.add(*map);
    open_maps_.signatures().see(looked.name, (*map)->build(), file);
  }

  const MapDirectory& before_;
  OpenMaps& open_maps_;
  const KeptLimits limits_;
  const Warn& warn_;
  std::atomic<std::size_t> held_{0};
  std::atomic<std::uint64_t> line_bytes_{0};
  std::map<std::string, SameName> candidates_;
  MapDirectory found_;
};

}  // namespace

Result<MapDirectory> read_directory(const fs::path& directory, const MapDirectory& before,
                                    const DirectoryChanges& changes, OpenMaps& open_maps,
                                    const KeptLimits& limits, const Warn& warn) {
  Scan scan(before, open_maps, limits, warn);
  if (changes.may_be_more) {
    const Result<std::vector<fs::path>> files = files_of(directory);
    if (!files) return files.error();
    for (const fs::path& file : *files) scan.look_at(file);
  } else {
    scan.look_again_at(changes.files);
  }
  scan.read_maps();
  return scan.result();
}

}  // namespace milepost::server
