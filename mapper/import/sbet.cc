#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "mapper/import/image_times.h"
#include "mapper/import/layouts.h"
#include "schema/base/file.h"

namespace milepost {

static_assert(std::endian::native == std::endian::little);

// Each record: time, latitude, longitude, altitude, velocities x y z, roll, pitch, platform
// heading, wander angle, accelerations x y z, angular rates x y z; seconds of the GPS week or day,
// radians and metres. The heading is the platform heading less the wander angle.
Result<Recording> read_sbet(const ImportOptions& options) {
  using Record = std::array<double, 17>;
  const Result<std::string> bytes = read_text_file(options.trajectory);
  if (!bytes) return bytes.error();
  const auto wrong = [&](const std::string& what) {
    return Error{ErrorCode::invalid_input, options.trajectory.string(), what,
                 "name a trajectory of 17 doubles a record, little endian"};
  };
  if (bytes->empty() || bytes->size() % sizeof(Record) != 0) {
    return wrong("has " + std::to_string(bytes->size()) + " bytes, no multiple of " +
                 std::to_string(sizeof(Record)));
  }
  Recording recording;
  recording.has_tilts = true;
  recording.poses.reserve(bytes->size() / sizeof(Record));
  for (std::size_t at = 0; at < bytes->size(); at += sizeof(Record)) {
    Record record;
    std::memcpy(record.data(), bytes->data() + at, sizeof(Record));
    const auto degrees = [&](std::size_t field) { return record[field] * kDegPerRad; };
    const GeoPoint position{degrees(1), degrees(2), record[3]};
    bool is_sound = is_valid(position) && record[0] >= 0;
    for (std::size_t field = 0; field < 11; ++field)
      is_sound = is_sound && std::isfinite(record[field]);
    if (!is_sound)
      return wrong("record " + std::to_string(at / sizeof(Record) + 1) + " is no pose");
    recording.poses.push_back(
        {record[0], {position, wrapped_360(degrees(9) - degrees(10)), degrees(8), degrees(7)}});
  }
  if (const Status added = add_images(options, recording); !added) return added.error();
  return recording;
}

}  // namespace milepost
