#include "mapper/import/ros/ros1_bag.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <system_error>

#include "mapper/import/ros/expansion.h"
#include "mapper/import/ros/ros1_record.h"

namespace milepost::ros {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";

// What the index tells of a chunk.
struct Chunk {
  std::uint64_t at = 0;
  std::vector<std::uint64_t> connections;  // whose messages it holds
};

class Ros1Bag : public Bag {
 public:
  Ros1Bag(fs::path file, std::unique_ptr<ByteSource> source)
      : file_(std::move(file)), source_(std::move(source)) {}

  // Reads the index. Errors: those of open_ros1_bag.
  Status open();

  Serialization serialization() const override { return Serialization::ros1; }
  const std::vector<BagTopic>& topics() const override { return topics_; }
  Status visit_messages(const std::vector<bool>& wanted, const Visit& visit) override;
  Result<ByteView> message_at(MessagePlace place) override;

 private:
  Error here(const Error& error, const std::string& place) const {
    return {error.code, file_.string() + place, error.what, error.hint};
  }
  Status read_index_record(const Ros1Record& record);
  Status add_connection(const Ros1Record& record);
  Status add_chunk(const Ros1Record& record);
  // The topic of a connection, if it is known.
  std::optional<std::size_t> topic_of(std::uint64_t connection) const {
    const auto known = topic_of_connection_.find(connection);
    if (known == topic_of_connection_.end()) return std::nullopt;
    return known->second;
  }
  // Makes a chunk the one that is held.
  Status load(std::uint64_t chunk_at);
  Status expand(std::uint64_t chunk_at);
  Status visit_chunk(std::uint64_t chunk_at, const std::vector<bool>& wanted, const Visit& visit);

  fs::path file_;
  std::unique_ptr<ByteSource> source_;
  std::vector<BagTopic> topics_;
  std::map<std::uint64_t, std::size_t> topic_of_connection_;
  std::vector<Chunk> chunks_;
  std::optional<std::uint64_t> held_at_;  // where the held chunk begins
  ExpandedBytes held_;
};

Status Ros1Bag::open() {
  const auto header = ros1_record_at(*source_, kMagic.size());
  if (!header) return here(header.error(), "");
  const auto index_at = header->header.number("index_pos");
  if (header->op != Ros1Op::bag_header || !index_at) {
    return Error{ErrorCode::corrupt, file_.string(), "has a damaged header",
                 "copy the bag again, or mend it with rosbag reindex"};
  }
  if (!header->header.text("encryptor").value_or("").empty()) {
    return Error{ErrorCode::invalid_input, file_.string(), "is encrypted",
                 "decrypt it with rosbag decrypt"};
  }
  if (*index_at == 0) {
    return Error{ErrorCode::invalid_input, file_.string(), "was not closed by its recorder",
                 "mend it with rosbag reindex"};
  }
  std::uint64_t count = 0;
  std::uint64_t at = *index_at;
  for (; at < source_->size(); ++count) {
    const auto record = ros1_record_at(*source_, at);
    if (!record) return here(record.error(), ", byte " + std::to_string(at));
    if (const Status read = read_index_record(*record); !read)
      return here(read.error(), ", byte " + std::to_string(at));
    at = record->end();
  }
  const auto connections = header->header.number("conn_count");
  const auto chunks = header->header.number("chunk_count");
  if (at != source_->size() || !connections || !chunks || *connections + *chunks != count) {
    return Error{ErrorCode::corrupt, file_.string(), "is truncated",
                 "copy the bag again, or mend it with rosbag reindex"};
  }
  std::ranges::sort(chunks_, {}, &Chunk::at);
  return ok_status();
}

Status Ros1Bag::read_index_record(const Ros1Record& record) {
  if (record.op == Ros1Op::connection) return add_connection(record);
  if (record.op == Ros1Op::chunk_info) return add_chunk(record);
  return ok_status();
}

Status Ros1Bag::add_connection(const Ros1Record& record) {
  const auto id = record.header.number("conn");
  if (!id) return id.error();
  const auto data = source_->bytes(record.data_at, record.data_bytes);
  if (!data) return data.error();
  const auto fields = Ros1Fields::parse(*data);
  if (!fields) return fields.error();
  // Several publishers of one topic are connections of their own.
  const BagTopic topic{std::string(record.header.text("topic").value_or("")),
                       std::string(fields->text("type").value_or(""))};
  const auto known = std::ranges::find_if(topics_, [&](const BagTopic& each) {
    return each.name == topic.name && each.type == topic.type;
  });
  topic_of_connection_[*id] = static_cast<std::size_t>(known - topics_.begin());
  if (known == topics_.end()) topics_.push_back(topic);
  return ok_status();
}

Status Ros1Bag::add_chunk(const Ros1Record& record) {
  const auto at = record.header.number("chunk_pos");
  if (!at) return at.error();
  auto data = source_->bytes(record.data_at, record.data_bytes);
  if (!data) return data.error();
  Chunk chunk{*at, {}};
  constexpr std::size_t kPairBytes = 8;  // a connection and the number of its messages
  for (; data->size() >= kPairBytes; *data = data->subspan(kPairBytes))
    chunk.connections.push_back(little_endian(data->first(kPairBytes / 2)));
  chunks_.push_back(std::move(chunk));
  return ok_status();
}

Status Ros1Bag::load(std::uint64_t chunk_at) {
  if (held_at_ == chunk_at) return ok_status();
  held_at_.reset();
  if (const Status expanded = expand(chunk_at); !expanded)
    return here(expanded.error(), ", chunk at byte " + std::to_string(chunk_at));
  held_at_ = chunk_at;
  return ok_status();
}

Status Ros1Bag::expand(std::uint64_t chunk_at) {
  const auto record = ros1_record_at(*source_, chunk_at);
  if (!record) return record.error();
  const auto size = record->header.number("size");
  if (record->op != Ros1Op::chunk || !size) {
    return Error{ErrorCode::corrupt, "", "there is none",
                 "copy the bag again, or mend it with rosbag reindex"};
  }
  const auto data = source_->bytes(record->data_at, record->data_bytes);
  if (!data) return data.error();
  held_ = {};  // one chunk at a time
  auto content = expanded_chunk(*data, record->header.text("compression").value_or(""), *size);
  if (!content) return content.error();
  held_ = std::move(*content);
  return ok_status();
}

Status Ros1Bag::visit_messages(const std::vector<bool>& wanted, const Visit& visit) {
  const auto is_wanted = [&](std::uint64_t connection) {
    const auto topic = topic_of(connection);
    return topic && wanted[*topic];
  };
  std::optional<std::uint64_t> latest_at;
  for (const Chunk& chunk : chunks_) {
    if (chunk.at == latest_at || std::ranges::none_of(chunk.connections, is_wanted)) continue;
    latest_at = chunk.at;
    if (const Status visited = visit_chunk(chunk.at, wanted, visit); !visited) return visited;
  }
  return ok_status();
}

Status Ros1Bag::visit_chunk(std::uint64_t chunk_at, const std::vector<bool>& wanted,
                            const Visit& visit) {
  if (const Status loaded = load(chunk_at); !loaded) return loaded;
  MemoryBytes content(held_.view());
  for (std::uint64_t at = 0; at < content.size();) {
    const auto record = ros1_record_at(content, at);
    if (!record) return here(record.error(), ", chunk at byte " + std::to_string(chunk_at));
    if (record->op == Ros1Op::message) {
      const auto connection = record->header.number("conn");
      const auto topic = connection ? topic_of(*connection) : std::nullopt;
      if (topic && wanted[*topic]) {
        const Status visited = visit(
            *topic, held_.view().subspan(record->data_at, record->data_bytes), {chunk_at, at});
        if (!visited) return visited;
      }
    }
    at = record->end();
  }
  return ok_status();
}

Result<ByteView> Ros1Bag::message_at(MessagePlace place) {
  if (const Status loaded = load(place.part); !loaded) return loaded.error();
  MemoryBytes content(held_.view());
  const auto record = ros1_record_at(content, place.at);
  if (!record) return here(record.error(), ", chunk at byte " + std::to_string(place.part));
  return held_.view().subspan(record->data_at, record->data_bytes);
}

}  // namespace

Result<std::unique_ptr<Bag>> open_ros1_bag(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    const bool exists = fs::exists(file, error);
    return Error{exists ? ErrorCode::invalid_input : ErrorCode::not_found, file.string(),
                 exists ? "is no file" : "there is no such file", "name the .bag file"};
  }
  const std::uint64_t size = fs::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (error || !stream) {
    return Error{ErrorCode::io, file.string(), "cannot be read", "check the permissions"};
  }
  auto source = std::make_unique<FileBytes>(std::move(stream), size);
  const auto magic = source->bytes(0, kMagic.size());
  if (!magic || as_text(*magic) != kMagic) {
    return Error{ErrorCode::invalid_input, file.string(), "is no bag of format 2.0",
                 "name a .bag file of ROS 1; older ones are converted by rosbag fix"};
  }
  auto bag = std::make_unique<Ros1Bag>(file, std::move(source));
  if (const Status opened = bag->open(); !opened) return opened.error();
  return std::unique_ptr<Bag>(std::move(bag));
}

}  // namespace milepost::ros
