// A tile written here is read by an independent reader: FlatBuffers' and zstd's Python packages.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <string>

#include "schema/tile/codec.h"
#include "tests/schema/tile/example_landmarks.h"
#include "tests/schema/tile/example_tile.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

constexpr int kModuleMissing = 77;

struct Reading {
  int exit_code = -1;
  std::string output;
};

Reading output_of(const std::string& command) {
  Reading reading;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> buffer{};
  std::size_t length = 0;
  while ((length = fread(buffer.data(), 1, buffer.size(), pipe)) > 0) {
    reading.output.append(buffer.data(), length);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) reading.exit_code = WEXITSTATUS(status);
  return reading;
}

// What the independent reader prints of an encoded tile.
Reading reading_of(const Bytes& frame) {
  const testing::TempFolder folder;
  std::ofstream(folder / "tile", std::ios::binary) << as_text(frame);
  const std::string script = "'" MILEPOST_READ_TILE "' '" MILEPOST_GENERATED_PYTHON "' '";
  return output_of("'" MILEPOST_PYTHON "' -B " + script + (folder / "tile").string() + "' 2>&1");
}

void expect_read(const Bytes& frame, const std::string& text) {
  const Reading reader = reading_of(frame);
  if (reader.exit_code == kModuleMissing) {
    GTEST_SKIP() << "install python3-flatbuffers and python3-zstandard: " << reader.output;
  }
  EXPECT_EQ(reader.exit_code, 0);
  EXPECT_EQ(reader.output, text);
}

TEST(ReadTile, AnIndependentReaderFindsTheSameTracklets) {
  const TrackletTile tile = testing::example_tile();
  expect_read(encode_tile(tile), testing::text_of(tile));
}

TEST(ReadTile, AnIndependentReaderFindsTheSameLandmarks) {
  const LandmarkTile tile = testing::example_landmarks();
  expect_read(encode_landmarks(tile), testing::text_of(quantized(tile)));
}

}  // namespace
}  // namespace milepost
