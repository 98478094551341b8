// One bit or one digit changed anywhere in what a client receives or has cached: it reads the map
// that was built, or an error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "client/fetch/http_source_parts.h"
#include "schema/base/digest.h"
#include "schema/base/digits.h"
#include "schema/store/sqlite.h"
#include "tests/client/fetch/fake_map.h"
#include "tests/support/temp_folder.h"

namespace milepost::testing {
namespace {

namespace fs = std::filesystem;

constexpr Bounds kAllCells{8, 48, 9, 50};
constexpr AlongRange kAllTiles{0, 200};
const GeoPoint kThere{49.0001, 8.4, 0};

// The bytes that a server sends, by target, and the damage on their way.
class Network {
 public:
  std::string body(const std::string& target) {
    auto [known, is_new] = bodies_.try_emplace(target);
    if (is_new) known->second = map_.answer(target).body;
    return known->second;
  }

  const FakeMap& map() const { return map_; }

  // Applied to each response.
  std::function<void(const std::string& target, Caches caches, std::string& body)> damage;
  bool is_away = false;
  std::vector<std::string> targets = {};  // that were requested

 private:
  const FakeMap map_;
  std::map<std::string, std::string> bodies_;
};

class NetworkTransport : public Transport {
 public:
  explicit NetworkTransport(Network& network) : network_(network) {}

  HttpAnswer get(const std::string& url, std::uint64_t limit_bytes, Caches caches,
                 const BodySink& sink, const Stopped& /*stopped*/) override {
    if (network_.is_away) return {Error{ErrorCode::unavailable, url, "away", ""}};
    const std::string target = url.substr(url.find("/v1"));
    network_.targets.push_back(target);
    std::string body = network_.body(target);
    if (network_.damage) network_.damage(target, caches, body);
    if (body.size() > limit_bytes) return {Error{ErrorCode::corrupt, url, "too long", ""}};
    Status taken = sink(as_bytes(body));
    return {std::move(taken), 0, body.size()};
  }

 private:
  Network& network_;
};

// What a vehicle reads of the fake map: everything that a fix depends on.
struct Reading {
  std::string segment;  // the line's numbers, successors, passes, position error, tile index
  std::string layers;   // names and focal lengths
  std::string tiles;
  std::string cells;
  std::string failures;  // the errors; where there is one, the part above is empty

  friend bool operator==(const Reading&, const Reading&) = default;
};

void PrintTo(const Reading& reading, std::ostream* out) {
  *out << reading.segment << "\n" << reading.layers << "\n" << reading.failures;
}

std::string text_of(double number) { return shortest(number) + " "; }

std::string text_of(const SegmentDescription& segment) {
  std::string text = segment.id + text_of(segment.length_m);
  for (const GeoPoint& point : segment.vertices) {
    text += text_of(point.latitude_deg) + text_of(point.longitude_deg) + text_of(point.altitude_m);
  }
  for (const Successor& successor : segment.successors) text += successor.map + successor.segment;
  for (const StoredPass& pass : segment.passes) {
    text += pass.drive + text_of(pass.from_m) + text_of(pass.to_m);
  }
  return text + text_of(segment.position_error.sigma_m.value_or(-1)) +
         text_of(segment.position_error.correlation_m.value_or(-1)) +
         (segment.position_error.is_assumed ? "assumed" : "");
}

std::string text_of(const std::vector<TileEntry>& index) {
  std::string text;
  for (const TileEntry& entry : index) {
    text += std::to_string(entry.index) + text_of(entry.along.from_m) + text_of(entry.along.to_m) +
            entry.digest + std::to_string(entry.items) + std::to_string(entry.bytes);
  }
  return text;
}

class DamageSweep : public ::testing::Test {
 protected:
  std::shared_ptr<MapSource> open_source(const fs::path& cache, std::uint64_t limit_bytes) {
    HttpSourceSettings settings;
    settings.server_url = "http://server";
    settings.cache_directory = cache;
    settings.cache_limit_bytes = limit_bytes;
    settings.attempts = 1;
    HttpSourceParts parts;
    parts.transport = std::make_unique<NetworkTransport>(network_);
    parts.sleep = [](double, const Stopped&) {};
    auto source = make_http_source(settings, std::move(parts));
    EXPECT_TRUE(source.ok());
    return std::move(source).value();
  }

  // Reads what the hints lead to, as a vehicle does.
  static Reading read(MapSource& source, const GeoPoint& position = kThere) {
    Reading reading;
    const auto failed = [&](const Error& error) {
      EXPECT_TRUE(error.code == ErrorCode::corrupt || error.code == ErrorCode::unavailable ||
                  error.code == ErrorCode::gone || error.code == ErrorCode::not_found)
          << error.line();
      reading.failures += error.line() + "\n";
    };
    const auto near = source.segments_near(position, 50);
    if (!near || near->empty()) {
      failed(near ? Error{ErrorCode::not_found, "", "no segment is near", ""} : near.error());
      return reading;
    }
    const MapVersion version = near->front().version;
    const std::string& id = near->front().segment;
    if (const auto map = source.describe(version)) {
      for (const auto& [name, layer] : map->layers) {
        reading.layers += name + (layer ? text_of(layer->focal_px()) : "-");
      }
      reading.layers += text_of(map->bounds.north_deg) + text_of(map->bounds.west_deg);
    } else {
      failed(map.error());
    }
    const auto segment = source.segment(version, id);
    const auto index = source.tile_index(version, id, "tracklets");
    if (segment && index) {
      reading.segment = text_of(*segment) + text_of(*index);
    } else {
      failed(segment ? index.error() : segment.error());
    }
    if (const auto tiles = source.tiles(version, id, "tracklets", kAllTiles)) {
      for (const EncodedTile& tile : *tiles) {
        reading.tiles += std::to_string(tile.index) + digest_of(tile.bytes);
      }
    } else {
      failed(tiles.error());
    }
    if (const auto cells = source.cells(version, "walls", kAllCells)) {
      for (const EncodedCell& cell : *cells) {
        reading.cells += std::to_string(cell.cell) + digest_of(cell.bytes);
      }
    } else {
      failed(cells.error());
    }
    return reading;
  }

  // Each part is the true one or missing with an error.
  void expect_true_or_failed(const Reading& reading, const std::string& what) const {
    const auto is_right = [&](const std::string Reading::*part) {
      return reading.*part == truth_.*part ||
             ((reading.*part).empty() && !reading.failures.empty());
    };
    ASSERT_TRUE(is_right(&Reading::segment)) << what;
    ASSERT_TRUE(is_right(&Reading::layers)) << what;
    ASSERT_TRUE(is_right(&Reading::tiles)) << what;
    ASSERT_TRUE(is_right(&Reading::cells)) << what;
  }

  // All that a vehicle requests, by target.
  std::vector<std::string> all_targets() {
    network_.targets.clear();
    const TempFolder fresh;
    read(*open_source(fresh.path(), 0));
    return network_.targets;
  }

  Network network_;
  TempFolder cache_;
  const Reading truth_ = [this] {
    const TempFolder fresh;
    return read(*open_source(fresh.path(), 0));
  }();
};

// Another digit where there is one, another bit elsewhere.
void change_byte(std::string& body, std::size_t at) {
  const auto byte = static_cast<unsigned char>(body[at]);
  if (std::isdigit(byte) != 0) {
    body[at] = body[at] == '9' ? '0' : static_cast<char>(byte + 1);
  } else {
    body[at] = static_cast<char>(byte ^ (1U << at % 8));
  }
}

// Every byte of a short document, and some hundred of a longer one: a digest is all or nothing.
std::size_t step_for(std::size_t length, std::size_t places) {
  return std::max<std::size_t>(1, length / places);
}

TEST_F(DamageSweep, TheTruthIsWhole) {
  EXPECT_EQ(truth_.failures, "");
  EXPECT_FALSE(truth_.segment.empty() || truth_.tiles.empty() || truth_.cells.empty());
}

TEST_F(DamageSweep, FromTheNetwork) {
  int failed = 0;
  int readings = 0;
  for (const std::string& spoilt : all_targets()) {
    const std::size_t length = network_.body(spoilt).size();
    for (std::size_t at = 0; at < length; at += step_for(length, 600)) {
      network_.damage = [&](const std::string& target, Caches, std::string& body) {
        if (target == spoilt) change_byte(body, at);
      };
      const Reading reading = read(*open_source(cache_.path(), 0));
      expect_true_or_failed(reading, spoilt + ", byte " + std::to_string(at));
      if (HasFatalFailure()) return;
      ++readings;
      if (!reading.failures.empty()) ++failed;
    }
  }
  // Only what a hint says of distances and lengths may change without an error: nobody relies on
  // it.
  EXPECT_GT(readings, 3000);
  EXPECT_GT(failed, readings - 100);
}

// Damage in a cache on the way: the second request goes past it.
TEST_F(DamageSweep, InACacheOnTheWay) {
  for (const std::string& spoilt : all_targets()) {
    if (spoilt.find("/builds/") == std::string::npos) continue;  // the others are not cached
    const std::size_t length = network_.body(spoilt).size();
    for (std::size_t at = 0; at < length; at += step_for(length, 100)) {
      network_.damage = [&](const std::string& target, Caches caches, std::string& body) {
        if (target == spoilt && caches == Caches::allowed) change_byte(body, at);
      };
      ASSERT_EQ(read(*open_source(cache_.path(), 0)), truth_) << spoilt << ", byte " << at;
    }
  }
}

class CacheDamageSweep : public DamageSweep {
 protected:
  CacheDamageSweep() { EXPECT_EQ(read(*open_source(cache_.path(), 1U << 30U)), truth_); }

  struct Row {
    std::int64_t id = 0;
    std::string key;
    std::string content;
  };

  std::vector<Row> rows() const {
    auto database = sqlite::Database::open(file(), sqlite::Access::read_write);
    EXPECT_TRUE(database.ok());
    auto select = database->prepare(
        "SELECT id, segment || '/' || layer || '/' || number, content FROM entries");
    EXPECT_TRUE(select.ok());
    std::vector<Row> rows;
    while (*select->step()) {
      rows.push_back({select->integer(0), select->text(1), select->text(2)});
    }
    return rows;
  }

  // Stores another content with its own digest: nothing in the row tells that it is wrong.
  static void put(sqlite::Database& database, std::int64_t id, const std::string& content) {
    auto update = database.prepare("UPDATE entries SET content = ?2, digest = ?3 WHERE id = ?1");
    ASSERT_TRUE(update.ok());
    update->bind(1, id).bind(2, as_bytes(content)).bind(3, digest_of(as_bytes(content)));
    ASSERT_TRUE(update->run().ok());
  }

  fs::path file() const { return cache_ / "tiles-1.sqlite"; }
};

TEST_F(CacheDamageSweep, InTheCachesRowsWithoutAServer) {
  network_.is_away = true;
  int unseen = 0;
  std::vector<Row> all = rows();
  for (Row& row : all) {
    const std::size_t step =
        step_for(row.content.size(), row.key.find("//") != std::string::npos ? 60 : 5);
    for (std::size_t at = 0; at < row.content.size(); at += step) {
      std::string changed = row.content;
      change_byte(changed, at);
      {
        auto database = sqlite::Database::open(file(), sqlite::Access::read_write);
        put(*database, row.id, changed);
      }
      const Reading reading = read(*open_source(cache_.path(), 1U << 30U));
      expect_true_or_failed(reading, row.key + ", byte " + std::to_string(at));
      if (HasFatalFailure()) return;
      if (reading.failures.empty()) ++unseen;
      // What was damaged has been removed, and is fetched again as the latest entry.
      network_.is_away = false;
      ASSERT_EQ(read(*open_source(cache_.path(), 1U << 30U)), truth_);
      network_.is_away = true;
      auto database = sqlite::Database::open(file(), sqlite::Access::read_write);
      auto find = database->prepare("SELECT max(id) FROM entries");
      ASSERT_TRUE(*find->step());
      row.id = find->integer(0);
    }
  }
  EXPECT_EQ(unseen, 0);
}

// Rows that have changed places: sound in themselves, but not what they are named.
TEST_F(CacheDamageSweep, InTheCachesKeys) {
  const std::vector<std::string> changes = {
      "UPDATE OR REPLACE entries SET number = number + 1 WHERE layer = 'tracklets'",
      "UPDATE OR REPLACE entries SET segment = 's2' WHERE layer = '' AND segment = 's1'",
      "UPDATE OR REPLACE entries SET number = 1 - number WHERE layer = '' AND segment = '' AND "
      "number < 2",
      "UPDATE OR REPLACE entries SET build = replace(build, '0', '1')",
      "UPDATE OR REPLACE entries SET map = 'village' WHERE layer <> ''",
      "UPDATE OR REPLACE entries SET layer = '' WHERE layer = 'tracklets' AND number = 2",
  };
  for (const std::string& change : changes) {
    SCOPED_TRACE(change);
    {
      auto database = sqlite::Database::open(file(), sqlite::Access::read_write);
      ASSERT_TRUE(database->execute(change).ok());
    }
    network_.is_away = true;
    expect_true_or_failed(read(*open_source(cache_.path(), 1U << 30U)), change);
    network_.is_away = false;
    EXPECT_EQ(read(*open_source(cache_.path(), 1U << 30U)), truth_);
  }
}

TEST_F(CacheDamageSweep, InTheCachesFile) {
  {
    auto database = sqlite::Database::open(file(), sqlite::Access::read_write);
    ASSERT_TRUE(database->execute("PRAGMA journal_mode = DELETE").ok());
  }
  const TempFolder copy;
  const auto whole = fs::file_size(file());
  for (std::uintmax_t at = 0; at < whole; at += 997) {
    for (const auto& entry : fs::directory_iterator(copy.path())) fs::remove_all(entry.path());
    fs::copy_file(file(), copy / "tiles-1.sqlite");
    {
      std::fstream bytes(copy / "tiles-1.sqlite", std::ios::in | std::ios::out | std::ios::binary);
      bytes.seekg(static_cast<std::streamoff>(at));
      const int byte = bytes.get();
      bytes.seekp(static_cast<std::streamoff>(at));
      bytes.put(static_cast<char>(byte ^ (1 << at % 8)));
    }
    network_.is_away = true;
    expect_true_or_failed(read(*open_source(copy.path(), 1U << 30U)), "byte " + std::to_string(at));
    if (HasFatalFailure()) return;
    network_.is_away = false;
    ASSERT_EQ(read(*open_source(copy.path(), 1U << 30U)), truth_) << "byte " << at;
  }
}

}  // namespace
}  // namespace milepost::testing
