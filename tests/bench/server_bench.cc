// A server with a map to measure, in the process that tests/bench/server drives.
//
// usage: server_bench FOLDER THREADS CERTIFICATE KEY
// Writes FOLDER/bench.map, with tiles of several sizes, and serves it without a log until standard
// input ends. Prints "port PORT TLS-PORT", then a line "NAME PATH" for each answer to measure.
#include <spdlog/spdlog.h>

#include <charconv>
#include <filesystem>
#include <iostream>
#include <random>
#include <string>
#include <string_view>

#include "schema/geo/route_line.h"
#include "schema/store/map_store.h"
#include "server/server.h"

namespace {

using namespace milepost;

constexpr int kRangeTiles = 260;  // of 100 kB: a range of 26 MB

Bytes random_bytes(std::size_t count, std::mt19937& random) {
  Bytes bytes(count);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

Status add_segment(MapWriter& writer) {
  const Result<RouteLine> line = RouteLine::from_vertices({{49, 8, 110}, {49.3, 8, 110}});
  if (!line) return line.error();
  return writer.add_segment(
      {"s1", line->length_m(), {{49, 8, 110, 0}, {49.3, 8, 110, line->length_m()}}, {}});
}

// Layer "range" has tiles of 100 kB, 100 m long each; every other layer one tile of a size.
Status add_tiles(MapWriter& writer) {
  std::mt19937 random(1);
  for (const std::size_t bytes : {4000U, 9600U, 32000U}) {
    const std::string layer = "tile-" + std::to_string(bytes);
    if (Status added = writer.add_layer(layer, "{}"); !added) return added;
    Status added = writer.add_tile("s1", layer, 0, {0, 100}, 1, random_bytes(bytes, random));
    if (!added) return added;
  }
  if (Status added = writer.add_layer("range", "{}"); !added) return added;
  for (std::uint32_t i = 0; i < kRangeTiles; ++i) {
    const AlongRange range{100.0 * i, 100.0 * (i + 1)};
    Status added = writer.add_tile("s1", "range", i, range, 1, random_bytes(100'000, random));
    if (!added) return added;
  }
  return ok_status();
}

Result<std::string> write_map(const std::filesystem::path& file) {
  Result<MapWriter> writer = MapWriter::create(file);
  if (!writer) return writer.error();
  if (Status set = writer->set_feature_json("{}"); !set) return set.error();
  if (Status added = add_segment(*writer); !added) return added.error();
  if (Status added = add_tiles(*writer); !added) return added.error();
  return writer->finish();
}

void print_paths(const std::string& build) {
  const std::string segment = "/v1/maps/bench/builds/" + build + "/segments/s1";
  for (const char* bytes : {"4000", "9600", "32000"}) {
    std::cout << "tile-" << bytes << ' ' << segment << "/tiles/tile-" << bytes << "/0\n";
  }
  std::cout << "map /v1/maps/bench\nsegment " << segment << "\nrange " << segment
            << "/tiles?layer=range&from_m=0&to_m=inf\nhealth /healthz\n"
            << std::flush;
}

Status serve(const std::filesystem::path& folder, unsigned threads, const server::TlsFiles& files) {
  spdlog::set_level(spdlog::level::off);
  const Result<std::string> build = write_map(folder / "bench.map");
  if (!build) return build.error();
  server::ServerSettings settings;
  settings.threads = threads;
  settings.listen = {{"127.0.0.1", 0, {}, true}, {}};
  const auto tls = server::TlsContext::load(files);
  if (!tls) return tls.error();
  settings.tls = std::make_shared<server::CurrentTls>(*tls);
  server::CatalogSettings maps;
  maps.open_maps.readers = settings.disk_threads;
  const auto catalog = server::Catalog::open(folder, maps, [](const std::string&) {});
  if (!catalog) return catalog.error();
  const auto running =
      server::Server::start(std::make_shared<server::CurrentCatalog>(*catalog), settings);
  if (!running) return running.error();
  const std::string& over_tls = (*running)->addresses().back();
  std::cout << "port " << (*running)->port() << ' ' << over_tls.substr(over_tls.rfind(':') + 1)
            << '\n';
  print_paths(*build);
  for (std::string line; std::getline(std::cin, line);) {
  }
  return ok_status();
}

}  // namespace

int main(int argc, char** argv) {
  unsigned threads = 0;
  const std::string_view count = argc == 5 ? argv[2] : "";
  std::from_chars(count.data(), count.data() + count.size(), threads);
  if (threads == 0) {
    std::cerr << "usage: server_bench FOLDER THREADS CERTIFICATE KEY\n";
    return 2;
  }
  const Status served = serve(argv[1], threads, {argv[3], argv[4]});
  if (!served) std::cerr << "server_bench: " << served.error().line() << '\n';
  return served ? 0 : 1;
}
