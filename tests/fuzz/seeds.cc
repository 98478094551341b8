// Writes well-formed inputs for each fuzz target: FOLDER/TARGET/NAME.
// usage: fuzz-seeds FOLDER
#include <bit>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "schema/base/file.h"
#include "schema/document/mapping_record.h"
#include "schema/document/signature.h"
#include "schema/feature/types.h"
#include "schema/store/sqlite.h"
#include "schema/tile/codec.h"
#include "schema/tile/zstd_frame.h"
#include "tests/client/fetch/fake_map.h"
#include "tests/mapper/import/ros/message_writer.h"
#include "tests/schema/tile/example_landmarks.h"
#include "tests/schema/tile/example_tile.h"
#include "tests/server/test_map.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;

class SeedFolder {
 public:
  explicit SeedFolder(fs::path root) : root_(std::move(root)) {}

  void write(const std::string& target, const std::string& name, std::string_view bytes) const {
    fs::create_directories(root_ / target);
    std::ofstream(root_ / target / name, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }

 private:
  fs::path root_;
};

void write_targets(const SeedFolder& seeds) {
  const server::TemporaryFolder folder;
  const std::string build = server::write_lane(folder.path() / "town.map").build;
  const std::string root = "/v1/maps/town/builds/" + build;
  int number = 0;
  for (const std::string& target :
       {std::string("/"), std::string("/healthz"), std::string("/openapi.yaml"),
        std::string("/v1/maps"), std::string("/v1/maps/town"),
        std::string("/v1/segments?near=49.0001,8.0001&radius_m=50"), root + "/segments/s1",
        root + "/segments/s1/tiles?layer=tracklets&from_m=10&to_m=120",
        root + "/segments/s1/tiles/tracklets/0", root + "/areas", root + "/manifest", root + "/map",
        root + "/mapping", "/viewer" + root.substr(3) + "/segments/s1/landmarks/0",
        "/viewer" + root.substr(3) + "/walls/" + std::to_string(server::kTownCells[0]),
        root + "/areas/walls?bbox=8,49,8.01,49.01",
        root + "/areas/walls/" + std::to_string(server::kTownCells[0]),
        std::string("http://host/v1/maps?%61=%20+")}) {
    seeds.write("http_target", std::to_string(number++), "GET\n\n" + target);
  }
  seeds.write("http_target", "conditional",
              "HEAD\n\"" + build + "\", W/\"x\", *\n" + root + "/areas");
  seeds.write("http_target", "method", "POST\n\n/v1/maps");
}

void write_heads(const SeedFolder& seeds) {
  const std::string get = "GET /v1/maps HTTP/1.1\r\nHost: h\r\n";
  seeds.write("http_head", "two", get + "\r\n" + get + "Connection: close\r\n\r\n");
  seeds.write("http_head", "length", get + "Content-Length: 3\r\n\r\nabc" + get + "\r\n");
  seeds.write(
      "http_head", "chunked",
      get + "Transfer-Encoding: chunked\r\n\r\n3;x=y\r\nabc\r\n0\r\nT: r\r\n\r\n" + get + "\r\n");
  seeds.write("http_head", "both",
              get + "Transfer-Encoding: chunked\r\nContent-Length: 3\r\n\r\nabc");
  seeds.write(
      "http_head", "plain",
      get + "If-None-Match: \"x\"\r\nConnection: Keep-Alive\r\nAccept:  */* \r\n\r\n" +
          "HEAD /v1/segments?near=49,8&radius_m=5 HTTP/1.1\r\nhost:\r\nconnection: close\r\n\r\n");
  seeds.write("http_head", "empty_lines", "\r\n\r\n" + get + "\r\n\r\n" + get + "\r\n");
  seeds.write("http_head", "expect", get + "Content-Length: 3\r\nExpect: 100-continue\r\n\r\nabc");
  seeds.write("http_head", "old", "HEAD / HTTP/1.0\r\nIf-None-Match: \"x\",\r\n W/\"y\"\r\n\r\n");
}

void write_tokens(const SeedFolder& seeds) {
  const std::string token = "mp_0123456789abcdef_" + std::string(64, '0');
  const std::string entry =
      R"({"id": "0123456789abcdef", "name": "fleet-7", "sha256": ")" + std::string(64, 'a');
  const std::string maps = R"(", "maps": ["town", "village"])";
  const auto file = [](const std::string& list) { return R"({"tokens": [)" + list + "]}"; };
  seeds.write("tokens", "none", "\n" + file(""));
  seeds.write("tokens", "some", "Bearer " + token + "\n" + file(entry + maps + "}"));
  seeds.write(
      "tokens", "expires",
      "bearer  " + token + "\n" + file(entry + maps + R"(, "expires": "2027-01-01T00:00:00Z"})"));
  seeds.write("tokens", "all", "Basic dTpw\n" + file(entry + R"(", "maps": "*"})"));
}

void write_request_fields(const SeedFolder& seeds) {
  const std::string tag = '"' + std::string(32, 'a') + '"';
  const std::string body(600, 'b');
  seeds.write("request_fields", "part",
              "bytes=10-19\n" + tag + "\n\ngzip\nhttps://a.example.org\n" + body);
  seeds.write("request_fields", "suffix", "bytes=-5\n\n*\nzstd;q=0.5, gzip;q=0.25, *;q=0\n\nb");
  seeds.write("request_fields", "beyond", "bytes=700-\n\nW/" + tag + ", \"x\"\n\n*\n" + body);
  seeds.write("request_fields", "several", "bytes=0-1,3-4\n\"x\"\n\nidentity;q=0\nnull\n");
}

void write_configurations(const SeedFolder& seeds) {
  const std::string maps = "maps = \"/srv/milepost\"\n";
  const std::string listen = "listen = \"[::1]:8080\"\n";
  seeds.write("configuration", "small", maps + listen);
  seeds.write(
      "configuration", "several",
      "# a comment\n" + maps + "listen = [\"plain:127.0.0.1:0\", \"unix:/run/s\"]\n" +
          "threads = 4\nlog-format = \"json\"\nlog-level = 'warn'\nready-needs-all = true\n");
  seeds.write("configuration", "access",
              maps + listen + "tls-cert = \"a.pem\"\ntls-key = \"a.key\"\ntokens = \"t.json\"\n" +
                  "requests-per-s = 2.5\nburst = 10\nallow-origin = [\"https://a.org\", \"*\"]\n");
  seeds.write("configuration", "unknown", maps + listen + "[section]\nkey = 1\n");
}

void write_footprints(const SeedFolder& seeds) {
  const std::string ring = "[[[8.1,49.1],[8.2,49.1],[8.2,49.15],[8.1,49.1]]]";
  const std::string polygon = R"({"type":"Polygon","coordinates":)" + ring + "}";
  const std::string many = R"({"type":"MultiPolygon","coordinates":[)" + ring + "," + ring + "]}";
  const std::string feature =
      R"({"type":"Feature","properties":{"a":[1,null,true]},"geometry":)" + polygon + "}";
  seeds.write("footprints", "collection",
              R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":)"
              R"("urn:ogc:def:crs:OGC:1.3:CRS84"}},"features":[)" +
                  feature + "]}");
  seeds.write("footprints", "geometries",
              R"({"type":"GeometryCollection","geometries":[)" + polygon + "," + many + "]}");
  seeds.write("footprints", "across",
              R"({"type":"Polygon","coordinates":[[[179.99,-0.01],[180.01,-0.01],[-179.99,0.01],)"
              R"([179.99,0.01],[179.99,-0.01]]]})");
  seeds.write("footprints", "lines", feature + "\n" + feature + "\n");
  seeds.write("footprints", "topology", R"({"type":"Topology","objects":{},"arcs":[]})");
}

void write_documents(const SeedFolder& seeds) {
  const testing::FakeMap map;
  seeds.write("documents", "catalog", "c" + map.catalog_document());
  seeds.write("documents", "near", "n" + map.near_document());
  seeds.write("documents", "placed",
              "t"
              R"({"segments":[{"map":"town","build":"00112233445566778899aabbccddeeff",)"
              R"("segment":"s1","bounds":{"west_deg":8,"south_deg":49,"east_deg":9,)"
              R"("north_deg":50}}],"static":true})");
  const SecretKey key(SecretKey::Seed{1});
  seeds.write("documents", "signature", "g" + signature_text({"town", map.build(), 1}, key));
  seeds.write("documents", "public_key", "k" + key.public_key().text());
  seeds.write("documents", "secret_key", "k" + key.text());
  seeds.write("documents", "map", "m" + map.map_document());
  seeds.write("documents", "manifest", "d" + map.manifest());
  seeds.write("documents", "segment", "s" + map.segment_document());
  MappingRecord record;
  record.drives = {{"monday", {130, 90000, 85000, 0.4, 0.01, 0.02, 0.03}}};
  record.segments = {{"s1", {{0, 10, "monday", {5, 3000, 2900, 0.4, 0.01, 0.02, 0.03}}}}};
  record.findings = {{"standstill", "monday", "trajectory.csv", "stands", "none", 3, 4}};
  record.check_points = {{"m1", "monday", 49, 8.4, 115, 3, true, 0.01, 0.02, 0.03, 0.4}};
  seeds.write("documents", "mapping", "p" + mapping_document(record));
  seeds.write("documents", "areas", "a" + map.areas_document());
  seeds.write("documents", "feature", "f" + to_json(FeatureParameters{}).dump());
  // A codebook whose bytes are all zero, in base64.
  seeds.write("documents", "codebook",
              R"(b{"version":"trained","step":0.02,"mean":")" + std::string(171, 'A') +
                  R"(=","axes":")" + std::string(5462, 'A') + R"(=="})");
}

ros::testing::MessageWriter message_of(ros::Serialization serialization) {
  ros::testing::MessageWriter writer(serialization);
  writer.header();
  return writer;
}

Bytes image_message(ros::Serialization serialization) {
  return message_of(serialization)
      .number(std::uint32_t{2})
      .number(std::uint32_t{3})
      .text("mono8")
      .number(std::uint8_t{0})
      .number(std::uint32_t{3})
      .bytes({1, 2, 3, 4, 5, 6})
      .message();
}

Bytes fix_message(ros::Serialization serialization) {
  return message_of(serialization)
      .number(std::int8_t{0})
      .number(std::uint16_t{1})
      .doubles({49, 8.4, 115})
      .doubles(9, 0)
      .number(std::uint8_t{0})
      .message();
}

std::string little_endian(std::uint64_t value, std::size_t bytes = 4) {
  std::string text;
  for (std::size_t i = 0; i < bytes; ++i) text += static_cast<char>(value >> 8 * i & 0xff);
  return text;
}

std::string with_length(const std::string& text) { return little_endian(text.size()) + text; }

std::string ros1_record(char op, const std::vector<std::string>& fields, const std::string& data) {
  std::string header = with_length(std::string("op=") + op);
  for (const std::string& field : fields) header += with_length(field);
  return with_length(header) + with_length(data);
}

// One chunk with one message.
std::string ros1_bag() {
  const std::string connection =
      ros1_record(7, {"conn=" + little_endian(0), "topic=/fix"},
                  with_length("topic=/fix") + with_length("type=sensor_msgs/NavSatFix"));
  const Bytes fix = fix_message(ros::Serialization::ros1);
  const std::string content =
      connection + ros1_record(2, {"conn=" + little_endian(0), "time=" + little_endian(12, 8)},
                               std::string(as_text(fix)));
  const std::string chunk =
      ros1_record(5, {"compression=none", "size=" + little_endian(content.size())}, content);
  const std::string magic = "#ROSBAG V2.0\n";
  const auto header = [](std::uint64_t index_at) {
    return ros1_record(3,
                       {"index_pos=" + little_endian(index_at, 8), "conn_count=" + little_endian(1),
                        "chunk_count=" + little_endian(1)},
                       "    ");
  };
  const std::size_t chunk_at = magic.size() + header(0).size();
  const std::string info = ros1_record(6, {"chunk_pos=" + little_endian(chunk_at, 8)},
                                       little_endian(0) + little_endian(1));
  return magic + header(chunk_at + chunk.size()) + chunk + connection + info;
}

std::string ros2_bag() {
  const server::TemporaryFolder folder;
  const fs::path file = folder.path() / "seed.db3";
  Result<sqlite::Database> bag = sqlite::Database::open(file, sqlite::Access::read_write);
  const bool is_made =
      bag.ok() &&
      bag->execute(
             "PRAGMA page_size = 512;"
             "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT,"
             " serialization_format TEXT);"
             "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER,"
             " data BLOB);"
             "INSERT INTO topics VALUES(1, '/fix', 'sensor_msgs/msg/NavSatFix', 'cdr')")
          .ok();
  if (!is_made) std::abort();
  auto insert = bag->prepare("INSERT INTO messages VALUES(1, 1, 12, ?)");
  if (!insert) std::abort();
  const Bytes fix = fix_message(ros::Serialization::cdr);
  insert->bind(1, fix);
  if (!insert->step()) std::abort();
  return *read_text_file(file);
}

void write_bags(const SeedFolder& seeds) {
  seeds.write("bags", "ros1", '1' + ros1_bag());
  seeds.write("bags", "ros2", '2' + ros2_bag());
  for (const auto& [kind, serialization] :
       {std::pair('r', ros::Serialization::ros1), std::pair('d', ros::Serialization::cdr)}) {
    for (const Bytes& message : {image_message(serialization), fix_message(serialization)}) {
      seeds.write("bags", kind + std::to_string(message.size()),
                  kind + std::string(as_text(message)));
    }
  }
}

void write_models(const SeedFolder& seeds) {
  const auto model = [](char kind, const std::string& cameras, const std::string& images) {
    return kind + little_endian(cameras.size(), 2) + cameras + images;
  };
  seeds.write("colmap", "text",
              model('t', "7 OPENCV 640 480 500 510 320 240 -0.2 0.05 0.001 -0.002\n",
                    "3 1 0 0 0 1 2 3 7 left/0001.png\n\n"));
  const auto doubles = [](const std::vector<double>& values) {
    std::string text;
    for (const double value : values) text += little_endian(std::bit_cast<std::uint64_t>(value), 8);
    return text;
  };
  seeds.write(
      "colmap", "binary",
      model('b',
            little_endian(1, 8) + little_endian(7) + little_endian(1) + little_endian(640, 8) +
                little_endian(480, 8) + doubles({500, 510, 320, 240}),
            little_endian(1, 8) + little_endian(3) + doubles({1, 0, 0, 0, 1, 2, 3}) +
                little_endian(7) + std::string("left/0001.png") + '\0' + little_endian(1, 8) +
                std::string(24, 'x')));
}

// An encoded tile, and its content, as inputs of target `tiles`.
void write_tile(const SeedFolder& seeds, char kind, const Bytes& encoded) {
  seeds.write("tiles", std::string("stored-") + kind,
              std::string(1, static_cast<char>(kind - 'a' + 'A')) + std::string(as_text(encoded)));
  const Result<Bytes> content = expand_frame(encoded);
  seeds.write("tiles", std::string("content-") + kind,
              std::string(1, kind) + std::string(as_text(*content)));
}

ObservationTile observations() {
  Track track;
  for (int i = 0; i < 3; ++i)
    track.push_back({{100.0F, 50.0F, 4.0F + static_cast<float>(i)}, {}, 2.0 * i});
  ObservedTracklet observed{testing::example_tile().tracklets.front(), track};
  set_from_track(track, observed.tracklet);
  return {"s", 0, ScaleModel::inverse_scale, {observed}};
}

ImageDescriptorTile frames() {
  DatabaseFrame frame{3, {{{10, 20, 5}}, {Descriptor{}}}, ImageDescriptor{0.5F}};
  return {"s", 0, {frame}};
}

WallTile walls() {
  const Wall wall{{49.0001, 8.0001}, {49.0002, 8.0003}, 0.4};
  return tiles_of({wall, {wall.end, {49.0003, 8.0001}, 0.4}}).front();
}

void write_tiles(const SeedFolder& seeds) {
  write_tile(seeds, 't', encode_tile(testing::example_tile()));
  write_tile(seeds, 'l', encode_landmarks(testing::example_landmarks()));
  write_tile(seeds, 'o', encode_observations(observations()));
  write_tile(seeds, 'f', encode_frames(frames()));
  write_tile(seeds, 'w', encode_walls(walls()));
}

// Small pages make a small file, in which a larger share of the bytes is significant.
std::string shrunk(const fs::path& map) {
  Result<sqlite::Database> database = sqlite::Database::open(map, sqlite::Access::read_write);
  if (!database || !database->execute("PRAGMA page_size = 512; VACUUM")) std::abort();
  return *read_text_file(map);
}

void write_maps(const SeedFolder& seeds) {
  const server::TemporaryFolder folder;
  const fs::path file = folder.path() / "seed.map";
  server::write_town(file, 20);
  const std::string town = shrunk(file);
  server::write_walls(file, {server::kTownCells[0]});
  const std::string walls = shrunk(file);
  for (const std::string reader : {"c", "s"}) {
    seeds.write("map_index", "town-" + reader, reader + town);
    seeds.write("map_index", "walls-" + reader, reader + walls);
  }
}

}  // namespace
}  // namespace milepost

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: fuzz-seeds FOLDER\n";
    return 2;
  }
  const milepost::SeedFolder seeds(argv[1]);
  milepost::write_targets(seeds);
  milepost::write_documents(seeds);
  milepost::write_bags(seeds);
  milepost::write_models(seeds);
  milepost::write_footprints(seeds);
  milepost::write_heads(seeds);
  milepost::write_tokens(seeds);
  milepost::write_request_fields(seeds);
  milepost::write_configurations(seeds);
  milepost::write_tiles(seeds);
  milepost::write_maps(seeds);
  return 0;
}
