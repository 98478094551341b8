#include "tests/schema/store/example_map.h"

#include <gtest/gtest.h>

#include <random>

#include "schema/base/file.h"

namespace milepost::testing {
namespace {

void expect_ok(const Status& status) {
  EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().line());
}

}  // namespace

Bytes tile_bytes(std::size_t size, std::uint32_t seed) {
  std::mt19937 random(seed);
  Bytes bytes(size);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

void add_example(MapWriter& writer) {
  expect_ok(writer.set_feature_json(R"({"kind": "sift"})"));
  expect_ok(writer.add_layer("tracklets", R"({"model":  "inverse_scale"})"));
  expect_ok(writer.add_layer("walls", "{}"));
  expect_ok(writer.add_segment({"west", 12.5, {{49.1, 8.5, 100, 0}, {49.2, 8.4, 101, 12.5}}, {}}));
  expect_ok(
      writer.add_segment({"east",
                          110.25,
                          {{49, 8.25, 110, 0}, {49.5, 8.75, 111.5, 60}, {49.25, 8.5, 112, 110.25}},
                          {{"west"}, {"north", "of-another-map"}},
                          {{"monday", 20, 130.25}, {"tuesday", 0, 110}},
                          {0.15, 120, true}}));
  for (std::uint32_t i = 0; i < 10; ++i) {
    const double from_m = 10.0 * i;
    const Bytes bytes = tile_bytes(3000 + 1000 * i, i);
    expect_ok(
        writer.add_tile("east", "tracklets", i, {from_m, i == 3 ? 80 : from_m + 25}, 5 + i, bytes));
  }
  expect_ok(writer.add_tile("west", "tracklets", 0, {0, 12}, 3, tile_bytes(50, 99)));
  expect_ok(writer.add_tile("east", "walls", 7, {70, 71}, 1, tile_bytes(40, 7)));
  for (const std::uint32_t cell : kCells) {
    expect_ok(writer.add_cell("walls", cell, 12, tile_bytes(500, cell)));
  }
}

std::string write_example(const std::filesystem::path& file) {
  Result<MapWriter> writer = MapWriter::create(file);
  EXPECT_TRUE(writer.ok());
  add_example(*writer);
  const Result<std::string> build = writer->finish();
  EXPECT_TRUE(build.ok()) << (build.ok() ? "" : build.error().line());
  return build.ok() ? *build : "";
}

std::string content_of(const std::filesystem::path& file) {
  const auto content = read_text_file(file);
  EXPECT_TRUE(content.ok());
  return content.ok() ? *content : "";
}

}  // namespace milepost::testing
