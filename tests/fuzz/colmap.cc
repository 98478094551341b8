// A model of COLMAP: the first byte chooses text ('t') or binary ('b'), the next two tell the
// length of the cameras' file, little endian; the rest is the images'.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "mapper/import/colmap_model.h"
#include "schema/base/bytes.h"
#include "tests/fuzz/check.h"
#include "tests/support/temp_folder.h"

namespace {

using namespace milepost;

void write(const std::filesystem::path& file, ByteView bytes) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << as_text(bytes);
}

void read(const std::string& ending, ByteView cameras, ByteView images) {
  const testing::TempFolder folder;
  write(folder / ("cameras" + ending), cameras);
  write(folder / ("images" + ending), images);
  const auto model = read_colmap_model(folder.path());
  if (!model) return;
  for (const ColmapImage& image : model->images) {
    fuzz::check(image.world_from_camera.matrix().allFinite());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kHeadBytes = 3;
  if (size < kHeadBytes || (data[0] != 't' && data[0] != 'b')) return 0;
  const ByteView content(data + kHeadBytes, size - kHeadBytes);
  const std::size_t cameras = std::min<std::size_t>(data[1] + 256U * data[2], content.size());
  read(data[0] == 't' ? ".txt" : ".bin", content.first(cameras), content.subspan(cameras));
  return 0;
}
