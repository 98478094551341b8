// A running server with a small map, for tests over real sockets.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>

#include "server/server.h"
#include "tests/server/connection.h"
#include "tests/server/test_map.h"

namespace milepost::server {

std::shared_ptr<const CurrentCatalog> served(std::shared_ptr<const Catalog> catalog);

class ServerTest : public ::testing::Test {
 protected:
  ServerTest();

  // With two threads, and a map of which each encoded tile has `frame_bytes`.
  void start(std::size_t frame_bytes = 1000, const ConnectionLimits& limits = {});
  void start(const ServerSettings& settings, std::size_t frame_bytes = 1000);

  std::string segment_path() const;
  std::string areas_path() const;
  std::string range_path(int from_m, int to_m) const;
  // The encoded tiles `first` to `last`, one after the other.
  std::string frames(std::size_t first, std::size_t last) const;
  bool serves() const;
  // Whether the server, now full, soon serves again.
  bool becomes_free() const;

  TemporaryFolder folder_;
  TownMap town_;
  std::unique_ptr<Server> server_;
  std::uint16_t port_ = 0;
};

}  // namespace milepost::server
