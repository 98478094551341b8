#include "mapper/import/ros/ros2_bag.h"

#include <algorithm>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "mapper/import/ros/expansion.h"
#include "schema/store/sqlite.h"

namespace milepost::ros {
namespace {

namespace fs = std::filesystem;

Error not_read(const fs::path& file, const std::string& what, const std::string& hint) {
  return {ErrorCode::invalid_input, file.string(), what, hint};
}

std::string type_of(std::string type) {
  constexpr std::string_view kOfRos2 = "/msg/";
  const std::size_t at = type.find(kOfRos2);
  if (at != std::string::npos) type.replace(at, kOfRos2.size(), "/");
  return type;
}

// One file of the bag, with its own numbers for topics.
struct Part {
  fs::path file;
  sqlite::Database database;
  std::map<std::int64_t, std::size_t> topic_of_id;
  std::optional<sqlite::Statement> message;  // by its id; made once
};

class Ros2Bag : public Bag {
 public:
  // Errors: those of open_ros2_bag.
  Status add(const fs::path& file);

  Serialization serialization() const override { return Serialization::cdr; }
  const std::vector<BagTopic>& topics() const override { return topics_; }
  Status visit_messages(const std::vector<bool>& wanted, const Visit& visit) override;
  Result<ByteView> message_at(MessagePlace place) override;

 private:
  Status read_topics(Part& part);
  Status visit_part(std::size_t index, const std::vector<bool>& wanted, const Visit& visit);
  // The message in a stored value: itself, or its content.
  Result<ByteView> message_in(ByteView stored, const Part& part, std::int64_t id);

  std::vector<BagTopic> topics_;
  std::vector<Part> parts_;
  ExpandedBytes held_;  // of a message that is compressed
};

Status Ros2Bag::add(const fs::path& file) {
  std::error_code error;
  const fs::path log = file.string() + "-wal";
  if (fs::exists(log, error) && !fs::is_empty(log, error)) {
    return not_read(file, "was not closed by its recorder",
                    "open it once with sqlite3, which takes in " + log.filename().string());
  }
  auto database = sqlite::Database::open(file, sqlite::Access::immutable);
  if (!database) return database.error();
  const auto tables = database->integer(
      "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name IN ('topics', 'messages')");
  if (!tables) {
    return Error{tables.error().code, file.string(),
                 "is no bag in SQLite, or damaged (" + tables.error().what + ")",
                 "name a .db3 file of ROS 2, or copy it again"};
  }
  if (*tables != 2) return not_read(file, "is no bag of ROS 2", "name a .db3 file, or its folder");
  Part part{file, std::move(*database), {}, {}};
  if (const Status read = read_topics(part); !read) return read;
  auto message = part.database.prepare("SELECT data FROM messages WHERE id = ?");
  if (!message) return message.error();
  part.message = std::move(*message);
  parts_.push_back(std::move(part));
  return ok_status();
}

Status Ros2Bag::read_topics(Part& part) {
  auto rows = part.database.prepare("SELECT id, name, type, serialization_format FROM topics");
  if (!rows) return rows.error();
  for (;;) {
    const auto row = rows->step();
    if (!row) return row.error();
    if (!*row) return ok_status();
    const BagTopic topic{rows->text(1), type_of(rows->text(2))};
    if (rows->text(3) != "cdr") {
      return not_read(part.file,
                      "the serialisation of " + topic.name + " is '" + rows->text(3) + "'",
                      "convert the bag to cdr");
    }
    const auto known = std::ranges::find_if(topics_, [&](const BagTopic& each) {
      return each.name == topic.name && each.type == topic.type;
    });
    part.topic_of_id[rows->integer(0)] = static_cast<std::size_t>(known - topics_.begin());
    if (known == topics_.end()) topics_.push_back(topic);
  }
}

Status Ros2Bag::visit_messages(const std::vector<bool>& wanted, const Visit& visit) {
  for (std::size_t i = 0; i < parts_.size(); ++i)
    if (const Status visited = visit_part(i, wanted, visit); !visited) return visited;
  return ok_status();
}

Status Ros2Bag::visit_part(std::size_t index, const std::vector<bool>& wanted, const Visit& visit) {
  const Part& part = parts_[index];
  std::string ids;
  for (const auto& [id, topic] : part.topic_of_id)
    if (wanted[topic]) ids += (ids.empty() ? "" : ",") + std::to_string(id);
  auto rows = part.database.prepare("SELECT id, topic_id, data FROM messages WHERE topic_id IN (" +
                                    ids + ") ORDER BY id");
  if (!rows) return rows.error();
  for (;;) {
    const auto row = rows->step();
    if (!row) return row.error();
    if (!*row) return ok_status();
    const std::int64_t id = rows->integer(0);
    const auto topic = part.topic_of_id.find(rows->integer(1));
    if (topic == part.topic_of_id.end()) continue;
    const auto message = message_in(rows->blob(2), part, id);
    if (!message) return message.error();
    const Status visited = visit(topic->second, *message, {index, static_cast<std::uint64_t>(id)});
    if (!visited) return visited;
  }
}

Result<ByteView> Ros2Bag::message_in(ByteView stored, const Part& part, std::int64_t id) {
  if (!is_zstd(stored)) return stored;
  auto content = expanded_zstd(stored);
  if (!content) {
    Error error = content.error();
    error.where = part.file.string() + ", message " + std::to_string(id);
    return error;
  }
  held_ = std::move(*content);
  return held_.view();
}

Result<ByteView> Ros2Bag::message_at(MessagePlace place) {
  Part& part = parts_[place.part];
  const auto id = static_cast<std::int64_t>(place.at);
  part.message->reset();
  part.message->bind(1, id);
  const auto row = part.message->step();
  if (!row) return row.error();
  if (*row) return message_in(part.message->blob(0), part, id);
  return Error{ErrorCode::corrupt, part.file.string(),
               "message " + std::to_string(id) + " is not found again", "copy the bag again"};
}

// The files of a bag's folder, by name. Errors: those of open_ros2_bag.
Result<std::vector<fs::path>> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::optional<fs::path> other;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const fs::path ending = at->path().extension();
    if (ending == ".db3") files.push_back(at->path());
    if (ending == ".zstd" || ending == ".mcap") other = at->path();
  }
  if (error) {
    return Error{ErrorCode::io, folder.string(), "cannot be read (" + error.message() + ")",
                 "check the permissions"};
  }
  if (other) return std::vector<fs::path>{*other};
  if (files.empty())
    return not_read(folder, "holds no .db3 file", "name the folder of a bag of ROS 2");
  std::ranges::sort(files);
  return files;
}

// Refuses what is no database by its ending.
Status check_kind(const fs::path& file) {
  if (file.extension() == ".zstd") {
    return not_read(file, "is compressed as a whole",
                    "decompress it with zstd -d and name the .db3 file");
  }
  if (file.extension() == ".mcap") {
    return not_read(file, "is an MCAP, which is not read",
                    "convert it with ros2 bag convert to the storage sqlite3");
  }
  return ok_status();
}

}  // namespace

Result<std::unique_ptr<Bag>> open_ros2_bag(const fs::path& file_or_folder) {
  std::error_code ignored;
  std::vector<fs::path> files = {file_or_folder};
  if (fs::is_directory(file_or_folder, ignored)) {
    auto in_folder = files_in(file_or_folder);
    if (!in_folder) return in_folder.error();
    files = std::move(*in_folder);
  }
  auto bag = std::make_unique<Ros2Bag>();
  for (const fs::path& file : files) {
    if (const Status kind = check_kind(file); !kind) return kind.error();
    if (const Status added = bag->add(file); !added) return added.error();
  }
  return std::unique_ptr<Bag>(std::move(bag));
}

}  // namespace milepost::ros
