#include "schema/tile/table.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "schema/base/ids.h"
#include "schema/tile/tile_generated.h"

namespace milepost {
namespace {

constexpr const char* kWrongTable =
    "the content is no verified FlatBuffer with the identifier MPT1";

Error broken(const std::string& where, const std::string& what, const std::string& paragraph) {
  return {ErrorCode::corrupt, where, what + " (FORMAT.md " + paragraph + ")",
          "fetch the tile again or replace the map by a good copy"};
}

double smallest_along_m(const TrackletTile& tile) {
  return tile.tracklets.empty() ? 0 : tile.along().from_m;
}

std::uint16_t whole_pixel(float px) {
  return static_cast<std::uint16_t>(std::clamp(px, 0.0F, 65535.0F));
}

// One array of the table: a value of every tracklet.
template <class Value>
auto column(flatbuffers::FlatBufferBuilder& builder, const std::vector<Tracklet>& tracklets,
            const std::function<Value(const Tracklet&)>& value_of) {
  std::vector<Value> values(tracklets.size());
  std::ranges::transform(tracklets, values.begin(), value_of);
  return builder.CreateVector(values);
}

auto descriptors(flatbuffers::FlatBufferBuilder& builder, const std::vector<Tracklet>& tracklets) {
  Bytes bytes;
  bytes.reserve(tracklets.size() * kDescriptorBytes);
  for (const Tracklet& t : tracklets) {
    bytes.insert(bytes.end(), t.descriptor.begin(), t.descriptor.end());
  }
  return builder.CreateVector(bytes);
}

flatbuffers::Offset<fbs::TrackletTile> build_table(flatbuffers::FlatBufferBuilder& builder,
                                                   const TrackletTile& tile) {
  const double origin_m = smallest_along_m(tile);
  const auto relative = [origin_m](double m) { return static_cast<float>(m - origin_m); };
  const auto floats = [&](const std::function<float(const Tracklet&)>& value_of) {
    return column<float>(builder, tile.tracklets, value_of);
  };
  const auto shorts = [&](const std::function<std::uint16_t(const Tracklet&)>& value_of) {
    return column<std::uint16_t>(builder, tile.tracklets, value_of);
  };
  // Named one by one: as arguments of one call their order in the bytes would be the compiler's.
  const auto segment = builder.CreateString(tile.segment);
  const auto bytes = descriptors(builder, tile.tracklets);
  const auto offset = floats([&](const Tracklet& t) { return relative(t.offset_m); });
  const auto slope = floats([](const Tracklet& t) { return static_cast<float>(t.slope); });
  const auto scale_min = floats([](const Tracklet& t) { return t.scale_min_px; });
  const auto scale_max = floats([](const Tracklet& t) { return t.scale_max_px; });
  const auto begin = floats([&](const Tracklet& t) { return relative(t.along.from_m); });
  const auto end = floats([&](const Tracklet& t) { return relative(t.along.to_m); });
  const auto x_min = shorts([](auto& t) { return whole_pixel(std::floor(t.pixels.x_min_px)); });
  const auto x_max = shorts([](auto& t) { return whole_pixel(std::ceil(t.pixels.x_max_px)); });
  const auto y_min = shorts([](auto& t) { return whole_pixel(std::floor(t.pixels.y_min_px)); });
  const auto y_max = shorts([](auto& t) { return whole_pixel(std::ceil(t.pixels.y_max_px)); });
  const auto r_squared = floats([](const Tracklet& t) { return t.r_squared; });
  const auto sigma = floats([](const Tracklet& t) { return t.residual_sigma_m; });
  const auto observations = shorts([](const Tracklet& t) { return t.observations; });
  return fbs::CreateTrackletTile(
      builder, segment, tile.index, static_cast<fbs::ScaleModel>(tile.model), origin_m,
      kDescriptorBytes, bytes, offset, slope, scale_min, scale_max, begin, end, x_min, x_max, y_min,
      y_max, r_squared, sigma, observations);
}

Status check_header(const fbs::TrackletTile& table) {
  if (!is_segment_id(table.segment()->string_view())) {
    return broken("tile", "the segment's id is not one", "3.4");
  }
  if (table.model() > fbs::ScaleModel::MAX) {
    return broken("tile", "the scale model is unknown", "3.4");
  }
  if (!(std::abs(table.origin_m()) <= kMaxAlongM)) {
    return broken("tile", "the origin is not an along", "3.4");
  }
  return ok_status();
}

// Whether every array has a value for each tracklet, no more and no fewer.
Status check_lengths(const fbs::TrackletTile& table, const std::string& where) {
  const std::size_t count = table.slope()->size();
  if (count > kMaxTrackletsPerTile) return broken(where, "more than 65536 tracklets", "3.5");
  if (table.descriptor_bytes() != kDescriptorBytes) {
    return broken(where, "a descriptor is not of 128 bytes", "3.5");
  }
  const std::pair<const char*, std::size_t> lengths[] = {
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
  };
  for (const auto& [name, length] : lengths) {
    if (length != count) {
      return broken(where, std::string("the length of ") + name + " is not that of slope", "3.5");
    }
  }
  if (table.descriptors()->size() != count * kDescriptorBytes) {
    return broken(where, "the length of descriptors is not 128 times that of slope", "3.5");
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

// Each comparison is written so that NaN fails it.
Status check_tracklet(const Tracklet& t, const std::string& where) {
  const struct {
    bool holds;
    const char* what;
    const char* paragraph;
  } rules[] = {
      {std::isfinite(t.offset_m), "the offset is not finite", "3.6"},
      {t.slope > 0 && std::isfinite(t.slope), "the slope is not finite and above 0", "3.6"},
      {t.scale_min_px > 0, "the smallest scale is not above 0", "3.7"},
      {t.scale_min_px <= t.scale_max_px && std::isfinite(t.scale_max_px),
       "the largest scale is not finite and at least the smallest", "3.7"},
      {std::abs(t.along.from_m) <= kMaxAlongM && std::abs(t.along.to_m) <= kMaxAlongM,
       "the along range is not one of alongs", "3.8"},
      {t.along.from_m <= t.along.to_m, "the along range ends before it begins", "3.8"},
      {t.pixels.x_min_px <= t.pixels.x_max_px && t.pixels.y_min_px <= t.pixels.y_max_px,
       "the pixel range ends before it begins", "3.9"},
      {t.r_squared >= 0 && t.r_squared <= 1, "R squared is not in [0, 1]", "3.10"},
      {t.residual_sigma_m >= 0 && std::isfinite(t.residual_sigma_m),
       "the residual sigma is not finite and at least 0", "3.10"},
      {t.observations >= 3, "fewer than 3 observations", "3.10"},
  };
  for (const auto& rule : rules) {
    if (!rule.holds) return broken(where, rule.what, rule.paragraph);
  }
  return ok_status();
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
    return broken("tile", kWrongTable, "3.3");
  const fbs::TrackletTile& table = *fbs::GetSizePrefixedTrackletTile(bytes.data());
  Status status = check_header(table);
  if (!status.ok()) return status.error();
  const std::string where = "tile " + table.segment()->str() + "/" + std::to_string(table.index());
  status = check_lengths(table, where);
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
