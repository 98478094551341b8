#include "tests/server/server_fixture.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <thread>

namespace milepost::server {

std::shared_ptr<const CurrentCatalog> served(std::shared_ptr<const Catalog> catalog) {
  return std::make_shared<CurrentCatalog>(std::move(catalog));
}

ServerTest::ServerTest() { spdlog::set_level(spdlog::level::off); }

void ServerTest::start(std::size_t frame_bytes, const ConnectionLimits& limits) {
  ServerSettings settings;
  settings.threads = 2;
  settings.limits = limits;
  start(settings, frame_bytes);
}

void ServerTest::start(const ServerSettings& settings, std::size_t frame_bytes) {
  town_ = write_town(folder_.path() / "town.map", frame_bytes);
  auto server =
      Server::start(served(open_catalog(folder_.path(), settings.disk_threads)), settings);
  ASSERT_TRUE(server.ok()) << server.error().line();
  server_ = std::move(*server);
  port_ = server_->port();
}

std::string ServerTest::segment_path() const {
  return "/v1/maps/town/builds/" + town_.build + "/segments/s1";
}

std::string ServerTest::areas_path() const {
  return "/v1/maps/town/builds/" + town_.build + "/areas";
}

std::string ServerTest::range_path(int from_m, int to_m) const {
  return segment_path() + "/tiles?layer=tracklets&from_m=" + std::to_string(from_m) +
         "&to_m=" + std::to_string(to_m);
}

std::string ServerTest::frames(std::size_t first, std::size_t last) const {
  std::string bytes;
  for (std::size_t i = first; i <= last; ++i) bytes += as_text(town_.frames[i]);
  return bytes;
}

bool ServerTest::serves() const { return fetch(port_, "/healthz").body == "ok\n"; }

bool ServerTest::becomes_free() const {
  for (int i = 0; i < 3000; ++i) {
    if (fetch(port_, "/healthz").status == 200) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

}  // namespace milepost::server
