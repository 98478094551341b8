#include "server/catalog/build_store.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <system_error>

#include "schema/base/digest.h"
#include "schema/store/held_file.h"
#include "schema/store/map_store.h"
#include "server/catalog/kept_builds.h"
#include "server/catalog/map_file.h"
#include "server/catalog/signature_file.h"

namespace milepost::server {
namespace fs = std::filesystem;
namespace {

Error io_error(const fs::path& file, const std::string& how, const std::error_code& why) {
  return {ErrorCode::io, file.string(), "cannot be " + how + " (" + why.message() + ")",
          "check the disk's space and the permissions"};
}

// On its way to its place; hidden, so that no server takes it for a map.
fs::path unfinished(const fs::path& file) {
  return file.parent_path() / ('.' + file.filename().string() + ".unfinished");
}

// So that it outlives a loss of power.
Status flush(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  const bool is_flushed = descriptor >= 0 && ::fsync(descriptor) == 0;
  const std::error_code error(errno, std::generic_category());
  if (descriptor >= 0) ::close(descriptor);
  return is_flushed ? ok_status() : Status(io_error(file, "written", error));
}

Status put(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) return io_error(to, "replaced", error);
  return flush(to.parent_path());
}

// A second name of the file, or a copy where the file system has no such names.
Status link_or_copy(const fs::path& from, const fs::path& to) {
  const fs::path step = unfinished(to);
  std::error_code error;
  fs::remove(step, error);
  fs::create_hard_link(from, step, error);
  if (error) fs::copy_file(from, step, fs::copy_options::overwrite_existing, error);
  if (error) return io_error(to, "written", error);
  if (Status flushed = flush(step); !flushed) return flushed;
  return put(step, to);
}

Status copy_whole(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
  return error ? Status(io_error(to, "written", error)) : flush(to);
}

// The build of a map file that was read to its last byte.
Result<std::string> checked_build(const fs::path& file) {
  const Result<MapReader> reader = MapReader::open(file);
  if (!reader) return reader.error();
  const Status sound = reader->verify();
  if (!sound) return sound.error();
  return reader->build();
}

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

// The signature goes before its map: a vehicle never finds the new build unsigned.
Status take_signature(const fs::path& from_map, const fs::path& to_map) {
  const fs::path from = signature_file_of(from_map);
  if (!is_there(from)) return ok_status();
  const fs::path to = signature_file_of(to_map);
  if (Status copied = copy_whole(from, unfinished(to)); !copied) return copied;
  return put(unfinished(to), to);
}

}  // namespace

std::vector<KeptBuild> BuildStore::kept(const std::string& map) const {
  std::vector<std::pair<std::int64_t, KeptBuild>> found;
  std::error_code error;
  fs::directory_iterator entry(kept_builds_folder(directory_, map), error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string build = entry->path().stem().string();
    const auto identity = identity_of(entry->path());
    if (entry->path().extension() != ".map" || !is_digest(build) || !identity) continue;
    // A new name changes the inode: the latest kept has the latest change.
    found.push_back({-identity->changed_ns, {build, entry->path()}});
  }
  std::ranges::sort(found, {},
                    [](const auto& each) { return std::pair(each.first, each.second.build); });
  std::vector<KeptBuild> builds;
  builds.reserve(found.size());
  for (auto& [order, kept] : found) builds.push_back(std::move(kept));
  return builds;
}

fs::path BuildStore::current_file(const std::string& map) const {
  return directory_ / (map + ".map");
}

Status BuildStore::keep_current(const std::string& map) {
  const fs::path current = current_file(map);
  if (!is_there(current)) return ok_status();
  const Result<MapReader> reader = MapReader::open(current);
  if (!reader) return ok_status();  // what cannot be served is not kept
  const fs::path file = kept_build_file(directory_, map, reader->build());
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) return io_error(file.parent_path(), "created", error);
  if (Status kept = link_or_copy(current, file); !kept) return kept;
  return take_signature(current, file);
}

void BuildStore::forget(const std::string& map, std::size_t keep) const {
  const std::vector<KeptBuild> builds = kept(map);
  std::error_code ignored;
  for (std::size_t i = keep; i < builds.size(); ++i) {
    fs::remove(builds[i].file, ignored);
    fs::remove(signature_file_of(builds[i].file), ignored);
  }
}

Result<std::string> BuildStore::install(const fs::path& file, std::size_t keep) {
  if (const Status is_map = check_map_file(file); !is_map) return is_map.error();
  const Result<std::string> name = map_name_of(file);
  if (!name) return name.error();
  const fs::path current = current_file(*name);
  const fs::path step = unfinished(current);
  const auto failed = [&](const Error& error) {
    std::error_code ignored;
    fs::remove(step, ignored);
    return error;
  };
  if (const Status copied = copy_whole(file, step); !copied) {
    return failed(
        {copied.error().code, current.string(), copied.error().what, copied.error().hint});
  }
  const Result<std::string> build = checked_build(step);
  if (!build) {
    Error error = build.error();
    const std::size_t at = error.where.find(step.string());
    if (at != std::string::npos) error.where.replace(at, step.string().size(), file.string());
    return failed(error);
  }
  if (const auto before = MapReader::open(current); before && before->build() == *build) {
    return failed({ErrorCode::invalid_input, file.string(),
                   "its build " + *build + " is the current one of map '" + *name + "' already",
                   "there is nothing to do"});
  }
  if (const Status kept = keep_current(*name); !kept) return failed(kept.error());
  if (const Status with = take_signature(file, current); !with) return failed(with.error());
  if (const Status renamed = put(step, current); !renamed) return failed(renamed.error());
  forget(*name, keep);
  return *build;
}

Result<std::string> BuildStore::roll_back(const std::string& map, const std::string& build) {
  const std::vector<KeptBuild> builds = kept(map);
  const auto current = MapReader::open(current_file(map));
  const auto is_wanted = [&](const KeptBuild& each) {
    return build.empty() ? !current || each.build != current->build() : each.build == build;
  };
  const auto wanted = std::ranges::find_if(builds, is_wanted);
  if (wanted == builds.end()) {
    return Error{ErrorCode::not_found, kept_builds_folder(directory_, map).string(),
                 build.empty() ? "keeps no older build" : "does not keep build " + build,
                 "see milepost-server rollback --list, or install the build's file"};
  }
  const Result<std::string> checked = checked_build(wanted->file);
  if (!checked) return checked.error();
  if (*checked != wanted->build) {
    return Error{ErrorCode::corrupt, wanted->file.string(), "is build " + *checked,
                 "install the build's file"};
  }
  if (const Status kept = keep_current(map); !kept) return kept.error();
  if (const Status with = take_signature(wanted->file, current_file(map)); !with)
    return with.error();
  if (const Status linked = link_or_copy(wanted->file, current_file(map)); !linked)
    return linked.error();
  return wanted->build;
}

}  // namespace milepost::server
