#include "schema/store/map_output.h"

#include <string_view>

#include "schema/store/map_content.h"

namespace milepost {
namespace {

// SQLite's file format, 1.3: the magic string, and a big-endian application_id at byte 68.
constexpr std::string_view kMagic("SQLite format 3\0", 16);
constexpr std::size_t kApplicationIdAt = 68;

bool begins_map(std::string_view head) {
  if (!head.starts_with(kMagic) || head.size() < kApplicationIdAt + 4) return false;
  std::int64_t id = 0;
  for (const char byte : head.substr(kApplicationIdAt, 4)) {
    id = id << 8U | static_cast<unsigned char>(byte);
  }
  return id == kMapApplicationId;
}

}  // namespace

const OutputKind kMapOutput = {"a milepost map", begins_map, false};

}  // namespace milepost
