#include "schema/tile/table.h"

#include <cmath>

#include "schema/tile/columns.h"
#include "schema/tile/tile_generated.h"

namespace milepost {
namespace {

constexpr const char* kNotTracklets =
    "the content is not a valid FlatBuffer with the identifier MPT1";

double smallest_along_m(const TrackletTile& tile) {
  return tile.tracklets.empty() ? 0 : tile.along().from_m;
}

flatbuffers::Offset<fbs::TrackletTile> build_table(flatbuffers::FlatBufferBuilder& builder,
                                                   const TrackletTile& tile) {
  const double origin_m = smallest_along_m(tile);
  const auto relative = [origin_m](double m) { return static_cast<float>(m - origin_m); };
  const auto floats = [&](auto value_of) {
    return builder.CreateVector(column<float>(tile.tracklets, value_of));
  };
  const auto shorts = [&](auto value_of) {
    return builder.CreateVector(column<std::uint16_t>(tile.tracklets, value_of));
  };
  // Separate statements: the order of evaluation of arguments, and so of the bytes, is unspecified.
  const auto segment = builder.CreateString(tile.segment);
  const auto bytes = builder.CreateVector(descriptor_column(
      tile.tracklets, [](auto& t) -> auto& { return t.descriptor; }));
  const auto offset = floats([&](auto& t) { return relative(t.offset_m); });
  const auto slope = floats([](auto& t) { return static_cast<float>(t.slope); });
  const auto scale_min = floats([](auto& t) { return t.scale_min_px; });
  const auto scale_max = floats([](auto& t) { return t.scale_max_px; });
  const auto begin = floats([&](auto& t) { return relative(t.along.from_m); });
  const auto end = floats([&](auto& t) { return relative(t.along.to_m); });
  const auto x_min = shorts([](auto& t) { return whole_pixel(std::floor(t.pixels.x_min_px)); });
  const auto x_max = shorts([](auto& t) { return whole_pixel(std::ceil(t.pixels.x_max_px)); });
  const auto y_min = shorts([](auto& t) { return whole_pixel(std::floor(t.pixels.y_min_px)); });
  const auto y_max = shorts([](auto& t) { return whole_pixel(std::ceil(t.pixels.y_max_px)); });
  const auto r_squared = floats([](auto& t) { return t.r_squared; });
  const auto sigma = floats([](auto& t) { return t.residual_sigma_m; });
  const auto observations = shorts([](auto& t) { return t.observations; });
  return fbs::CreateTrackletTile(
      builder, segment, tile.index, static_cast<fbs::ScaleModel>(tile.model), origin_m,
      kDescriptorBytes, bytes, offset, slope, scale_min, scale_max, begin, end, x_min, x_max, y_min,
      y_max, r_squared, sigma, observations);
}

// Checks that every array has exactly one value per tracklet.
Status check_arrays(const fbs::TrackletTile& table, const std::string& where) {
  const std::size_t count = table.slope()->size();
  if (count > kMaxTrackletsPerTile) return broken_tile(where, "more than 65536 tracklets", "3.5");
  if (table.descriptor_bytes() != kDescriptorBytes) {
    return broken_tile(where, "a descriptor does not have 128 bytes", "3.5");
  }
  const Status lengths = check_lengths(where, {"slope", count},
                                       {
                                           {"offset_m", table.offset_m()->size()},
                                           {"scale_min_px", table.scale_min_px()->size()},
                                           {"scale_max_px", table.scale_max_px()->size()},
                                           {"along_begin_m", table.along_begin_m()->size()},
                                           {"along_end_m", table.along_end_m()->size()},
                                           {"x_min_px", table.x_min_px()->size()},
                                           {"x_max_px", table.x_max_px()->size()},
                                           {"y_min_px", table.y_min_px()->size()},
                                           {"y_max_px", table.y_max_px()->size()},
                                           {"r_squared", table.r_squared()->size()},
                                           {"residual_sigma_m", table.residual_sigma_m()->size()},
                                           {"observations", table.observations()->size()},
                                       },
                                       "3.5");
  if (!lengths.ok()) return lengths;
  if (table.descriptors()->size() != count * kDescriptorBytes) {
    return broken_tile(where, "the length of descriptors is not 128 times that of slope", "3.5");
  }
  return ok_status();
}

Tracklet tracklet_at(const fbs::TrackletTile& table, flatbuffers::uoffset_t i) {
  Tracklet t;
  std::copy_n(table.descriptors()->data() + std::size_t{i} * kDescriptorBytes, kDescriptorBytes,
              t.descriptor.begin());
  t.offset_m = table.origin_m() + table.offset_m()->Get(i);
  t.slope = table.slope()->Get(i);
  t.scale_min_px = table.scale_min_px()->Get(i);
  t.scale_max_px = table.scale_max_px()->Get(i);
  t.along = {table.origin_m() + table.along_begin_m()->Get(i),
             table.origin_m() + table.along_end_m()->Get(i)};
  t.pixels = {
      static_cast<float>(table.x_min_px()->Get(i)), static_cast<float>(table.x_max_px()->Get(i)),
      static_cast<float>(table.y_min_px()->Get(i)), static_cast<float>(table.y_max_px()->Get(i))};
  t.r_squared = table.r_squared()->Get(i);
  t.residual_sigma_m = table.residual_sigma_m()->Get(i);
  t.observations = table.observations()->Get(i);
  return t;
}

}  // namespace

Bytes table_from_tile(const TrackletTile& tile) {
  flatbuffers::FlatBufferBuilder builder;
  fbs::FinishSizePrefixedTrackletTileBuffer(builder, build_table(builder, tile));
  return {builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize()};
}

Result<TrackletTile> tile_from_table(ByteView bytes) {
  flatbuffers::Verifier verifier(bytes.data(), bytes.size());
  if (!fbs::VerifySizePrefixedTrackletTileBuffer(verifier))
    return broken_tile("tile", kNotTracklets, "3.3");
  const fbs::TrackletTile& table = *fbs::GetSizePrefixedTrackletTile(bytes.data());
  Status status = check_head(table.segment()->string_view(), table.origin_m());
  if (status.ok()) status = check_model(static_cast<std::uint8_t>(table.model()));
  if (!status.ok()) return status.error();
  const std::string where = place_of(table);
  status = check_arrays(table, where);
  if (!status.ok()) return status.error();

  TrackletTile tile{
      table.segment()->str(), table.index(), static_cast<ScaleModel>(table.model()), {}};
  const flatbuffers::uoffset_t count = table.slope()->size();
  tile.tracklets.reserve(count);
  for (flatbuffers::uoffset_t i = 0; i < count; ++i) {
    tile.tracklets.push_back(tracklet_at(table, i));
    status = check_tracklet(tile.tracklets.back(), where + ", tracklet " + std::to_string(i));
    if (!status.ok()) return status.error();
  }
  return tile;
}

}  // namespace milepost
