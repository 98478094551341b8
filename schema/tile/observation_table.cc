#include <algorithm>
#include <cmath>
#include <numeric>

#include "schema/tile/columns.h"
#include "schema/tile/observation_tile_generated.h"
#include "schema/tile/table.h"

namespace milepost {
namespace {

constexpr const char* kNotObservations =
    "the content is not a valid FlatBuffer with the identifier MPO1";

double smallest_along_m(const ObservationTile& tile) {
  if (tile.tracklets.empty()) return 0;
  return std::ranges::min(tile.tracklets, {}, [](auto& t) { return t.tracklet.along.from_m; })
      .tracklet.along.from_m;
}

Track observations_of(const ObservationTile& tile) {
  Track all;
  for (const ObservedTracklet& t : tile.tracklets) {
    all.insert(all.end(), t.track.begin(), t.track.end());
  }
  return all;
}

flatbuffers::Offset<fbs::ObservationTile> build_table(flatbuffers::FlatBufferBuilder& builder,
                                                      const ObservationTile& tile) {
  const double origin_m = smallest_along_m(tile);
  const auto relative = [origin_m](double m) { return static_cast<float>(m - origin_m); };
  const auto floats = [&](const auto& items, auto value_of) {
    return builder.CreateVector(column<float>(items, value_of));
  };
  const auto shorts = [&](const auto& items, auto value_of) {
    return builder.CreateVector(column<std::uint16_t>(items, value_of));
  };
  const auto& tracklets = tile.tracklets;
  const Track all = observations_of(tile);
  // Separate statements: the order of evaluation of arguments, and so of the bytes, is unspecified.
  const auto segment = builder.CreateString(tile.segment);
  const auto offset = floats(tracklets, [&](auto& t) { return relative(t.tracklet.offset_m); });
  const auto slope =
      floats(tracklets, [](auto& t) { return static_cast<float>(t.tracklet.slope); });
  const auto r_squared = floats(tracklets, [](auto& t) { return t.tracklet.r_squared; });
  const auto sigma = floats(tracklets, [](auto& t) { return t.tracklet.residual_sigma_m; });
  const auto counts = shorts(tracklets, [](auto& t) { return t.tracklet.observations; });
  const auto bytes = builder.CreateVector(descriptor_column(
      all, [](auto& o) -> auto& { return o.descriptor; }));
  const auto along = floats(all, [&](auto& o) { return relative(o.along_m); });
  const auto scale = floats(all, [](auto& o) { return o.feature.scale_px; });
  const auto x = shorts(all, [](auto& o) { return whole_pixel(std::round(o.feature.x_px)); });
  const auto y = shorts(all, [](auto& o) { return whole_pixel(std::round(o.feature.y_px)); });
  return fbs::CreateObservationTile(
      builder, segment, tile.index, static_cast<fbs::ScaleModel>(tile.model), origin_m,
      kDescriptorBytes, offset, slope, r_squared, sigma, counts, bytes, along, scale, x, y);
}

Status check_arrays(const fbs::ObservationTile& table, const std::string& where) {
  const std::size_t count = table.slope()->size();
  if (count > kMaxTrackletsPerTile) return broken_tile(where, "more than 65536 tracklets", "4.3");
  if (table.descriptor_bytes() != kDescriptorBytes) {
    return broken_tile(where, "a descriptor does not have 128 bytes", "4.4");
  }
  const Status of_tracklets = check_lengths(where, {"slope", count},
                                            {{"offset_m", table.offset_m()->size()},
                                             {"r_squared", table.r_squared()->size()},
                                             {"residual_sigma_m", table.residual_sigma_m()->size()},
                                             {"observations", table.observations()->size()}},
                                            "4.3");
  if (!of_tracklets.ok()) return of_tracklets;
  const std::size_t observations = table.scale_px()->size();
  const auto& counts = *table.observations();
  if (std::accumulate(counts.begin(), counts.end(), std::size_t{0}) != observations) {
    return broken_tile(where, "the length of scale_px is not the sum of observations", "4.4");
  }
  if (table.descriptors()->size() != observations * kDescriptorBytes) {
    return broken_tile(where, "the length of descriptors is not 128 times that of scale_px", "4.4");
  }
  return check_lengths(where, {"scale_px", observations},
                       {{"along_m", table.along_m()->size()},
                        {"x_px", table.x_px()->size()},
                        {"y_px", table.y_px()->size()}},
                       "4.4");
}

Observation observation_at(const fbs::ObservationTile& table, flatbuffers::uoffset_t i) {
  Observation o;
  o.feature = {static_cast<float>(table.x_px()->Get(i)), static_cast<float>(table.y_px()->Get(i)),
               table.scale_px()->Get(i)};
  std::copy_n(table.descriptors()->data() + std::size_t{i} * kDescriptorBytes, kDescriptorBytes,
              o.descriptor.begin());
  o.along_m = table.origin_m() + table.along_m()->Get(i);
  return o;
}

// Each comparison is written so that NaN fails it.
Status check_track(const Track& track, const std::string& where) {
  if (track.size() < 3) return broken_tile(where, "fewer than 3 observations", "4.3");
  for (std::size_t m = 0; m < track.size(); ++m) {
    if (!(track[m].feature.scale_px > 0 && std::isfinite(track[m].feature.scale_px))) {
      return broken_tile(where, "a scale is not finite and above 0", "4.5");
    }
    if (!(std::abs(track[m].along_m) <= kMaxAlongM)) {
      return broken_tile(where, "along_m of an observation is out of range", "4.5");
    }
    if (m > 0 && !(track[m - 1].along_m < track[m].along_m)) {
      return broken_tile(where, "along_m of the observations does not ascend", "4.5");
    }
  }
  return ok_status();
}

// The tracklet `i`, whose observations begin at `first`.
Result<ObservedTracklet> tracklet_at(const fbs::ObservationTile& table, flatbuffers::uoffset_t i,
                                     flatbuffers::uoffset_t first, const std::string& where) {
  ObservedTracklet t;
  const std::uint16_t count = table.observations()->Get(i);
  t.track.reserve(count);
  for (flatbuffers::uoffset_t m = 0; m < count; ++m) {
    t.track.push_back(observation_at(table, first + m));
  }
  Status status = check_track(t.track, where);
  if (!status.ok()) return status.error();
  t.tracklet.offset_m = table.origin_m() + table.offset_m()->Get(i);
  t.tracklet.slope = table.slope()->Get(i);
  t.tracklet.r_squared = table.r_squared()->Get(i);
  t.tracklet.residual_sigma_m = table.residual_sigma_m()->Get(i);
  set_from_track(t.track, t.tracklet);
  status = check_tracklet(t.tracklet, where);
  if (!status.ok()) return status.error();
  return t;
}

}  // namespace

Bytes table_from_observations(const ObservationTile& tile) {
  flatbuffers::FlatBufferBuilder builder;
  fbs::FinishSizePrefixedObservationTileBuffer(builder, build_table(builder, tile));
  return {builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize()};
}

Result<ObservationTile> observations_from_table(ByteView bytes) {
  flatbuffers::Verifier verifier(bytes.data(), bytes.size());
  if (!fbs::VerifySizePrefixedObservationTileBuffer(verifier))
    return broken_tile("tile", kNotObservations, "4.2");
  const fbs::ObservationTile& table = *fbs::GetSizePrefixedObservationTile(bytes.data());
  Status status = check_head(table.segment()->string_view(), table.origin_m());
  if (status.ok()) status = check_model(static_cast<std::uint8_t>(table.model()));
  if (!status.ok()) return status.error();
  const std::string where = place_of(table);
  status = check_arrays(table, where);
  if (!status.ok()) return status.error();

  ObservationTile tile{
      table.segment()->str(), table.index(), static_cast<ScaleModel>(table.model()), {}};
  flatbuffers::uoffset_t first = 0;
  for (flatbuffers::uoffset_t i = 0; i < table.slope()->size(); ++i) {
    Result<ObservedTracklet> tracklet =
        tracklet_at(table, i, first, where + ", tracklet " + std::to_string(i));
    if (!tracklet) return tracklet.error();
    tile.tracklets.push_back(std::move(*tracklet));
    first += table.observations()->Get(i);
  }
  return tile;
}

}  // namespace milepost
