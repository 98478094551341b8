#include <algorithm>
#include <cmath>
#include <numeric>

#include "schema/tile/columns.h"
#include "schema/tile/frame_tile_generated.h"
#include "schema/tile/table.h"

namespace milepost {
namespace {

constexpr const char* kNotFrames = "the content is not a valid FlatBuffer with the identifier MPF1";

FeatureSet features_of(const ImageDescriptorTile& tile) {
  FeatureSet all;
  for (const DatabaseFrame& frame : tile.frames) {
    const FeatureSet& set = frame.features;
    all.features.insert(all.features.end(), set.features.begin(), set.features.end());
    all.descriptors.insert(all.descriptors.end(), set.descriptors.begin(), set.descriptors.end());
  }
  return all;
}

std::vector<float> image_values_of(const ImageDescriptorTile& tile) {
  std::vector<float> values;
  for (const DatabaseFrame& frame : tile.frames) {
    if (frame.image) values.insert(values.end(), frame.image->begin(), frame.image->end());
  }
  return values;
}

flatbuffers::Offset<fbs::ImageDescriptorTile> build_table(flatbuffers::FlatBufferBuilder& builder,
                                                          const ImageDescriptorTile& tile) {
  const double origin_m = tile.frames.empty() ? 0 : tile.frames.front().along_m;
  const bool has_images = !tile.frames.empty() && tile.frames.front().image;
  const FeatureSet all = features_of(tile);
  const auto shorts = [&](auto value_of) {
    return builder.CreateVector(column<std::uint16_t>(all.features, value_of));
  };
  // Separate statements: the order of evaluation of arguments, and so of the bytes, is unspecified.
  const auto segment = builder.CreateString(tile.segment);
  const auto along = builder.CreateVector(column<float>(
      tile.frames, [&](auto& frame) { return static_cast<float>(frame.along_m - origin_m); }));
  const auto counts = builder.CreateVector(column<std::uint32_t>(
      tile.frames, [](auto& frame) { return static_cast<std::uint32_t>(frame.features.size()); }));
  const auto images = builder.CreateVector(image_values_of(tile));
  const auto bytes = builder.CreateVector(descriptor_column(
      all.descriptors, [](auto& descriptor) -> auto& { return descriptor; }));
  const auto scale = builder.CreateVector(
      column<float>(all.features, [](auto& feature) { return feature.scale_px; }));
  const auto x = shorts([](auto& feature) { return whole_pixel(std::round(feature.x_px)); });
  const auto y = shorts([](auto& feature) { return whole_pixel(std::round(feature.y_px)); });
  return fbs::CreateImageDescriptorTile(builder, segment, tile.index, origin_m, kDescriptorBytes,
                                        has_images ? kImageDescriptorValues : 0, along, counts,
                                        images, bytes, scale, x, y);
}

Status check_arrays(const fbs::ImageDescriptorTile& table, const std::string& where) {
  const std::size_t frames = table.along_m()->size();
  if (table.features()->size() != frames) {
    return broken_tile(where, "the length of features is not that of along_m", "4.7");
  }
  if (table.image_values() != 0 && table.image_values() != kImageDescriptorValues) {
    return broken_tile(where, "an image descriptor does not have 64 values", "4.8");
  }
  if (table.image_descriptors()->size() != frames * table.image_values()) {
    return broken_tile(where, "the length of image_descriptors is not image_values times along_m's",
                       "4.8");
  }
  if (table.descriptor_bytes() != kDescriptorBytes) {
    return broken_tile(where, "a descriptor does not have 128 bytes", "4.9");
  }
  const std::size_t features = table.scale_px()->size();
  const auto& counts = *table.features();
  if (std::accumulate(counts.begin(), counts.end(), std::size_t{0}) != features) {
    return broken_tile(where, "the length of scale_px is not the sum of features", "4.9");
  }
  if (table.descriptors()->size() != features * kDescriptorBytes) {
    return broken_tile(where, "the length of descriptors is not 128 times that of scale_px", "4.9");
  }
  return check_lengths(where, {"scale_px", features},
                       {{"x_px", table.x_px()->size()}, {"y_px", table.y_px()->size()}}, "4.9");
}

// Each comparison is written so that NaN fails it.
Result<ImageDescriptor> image_at(const fbs::ImageDescriptorTile& table, flatbuffers::uoffset_t i,
                                 const std::string& where) {
  ImageDescriptor image;
  for (flatbuffers::uoffset_t k = 0; k < kImageDescriptorValues; ++k) {
    image[k] = table.image_descriptors()->Get(i * kImageDescriptorValues + k);
    if (!(std::abs(image[k]) <= 1)) {
      return broken_tile(where, "a value of the image descriptor is not in [-1, 1]", "4.8");
    }
  }
  return image;
}

// The frame `i`, whose features begin at `first`.
Result<DatabaseFrame> frame_at(const fbs::ImageDescriptorTile& table, flatbuffers::uoffset_t i,
                               flatbuffers::uoffset_t first, const std::string& where) {
  DatabaseFrame frame;
  frame.along_m = table.origin_m() + table.along_m()->Get(i);
  if (!(std::abs(frame.along_m) <= kMaxAlongM)) {
    return broken_tile(where, "its along_m is out of range", "4.7");
  }
  if (table.image_values() > 0) {
    const Result<ImageDescriptor> image = image_at(table, i, where);
    if (!image) return image.error();
    frame.image = *image;
  }
  for (flatbuffers::uoffset_t k = first; k < first + table.features()->Get(i); ++k) {
    const float scale_px = table.scale_px()->Get(k);
    if (!(scale_px > 0 && std::isfinite(scale_px))) {
      return broken_tile(where, "a scale is not finite and above 0", "4.9");
    }
    frame.features.features.push_back({static_cast<float>(table.x_px()->Get(k)),
                                       static_cast<float>(table.y_px()->Get(k)), scale_px});
    std::copy_n(table.descriptors()->data() + std::size_t{k} * kDescriptorBytes, kDescriptorBytes,
                frame.features.descriptors.emplace_back().begin());
  }
  return frame;
}

}  // namespace

Bytes table_from_frames(const ImageDescriptorTile& tile) {
  flatbuffers::FlatBufferBuilder builder;
  fbs::FinishSizePrefixedImageDescriptorTileBuffer(builder, build_table(builder, tile));
  return {builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize()};
}

Result<ImageDescriptorTile> frames_from_table(ByteView bytes) {
  flatbuffers::Verifier verifier(bytes.data(), bytes.size());
  if (!fbs::VerifySizePrefixedImageDescriptorTileBuffer(verifier))
    return broken_tile("tile", kNotFrames, "4.6");
  const fbs::ImageDescriptorTile& table = *fbs::GetSizePrefixedImageDescriptorTile(bytes.data());
  Status status = check_head(table.segment()->string_view(), table.origin_m());
  if (!status.ok()) return status.error();
  const std::string where = place_of(table);
  status = check_arrays(table, where);
  if (!status.ok()) return status.error();

  ImageDescriptorTile tile{table.segment()->str(), table.index(), {}};
  flatbuffers::uoffset_t first = 0;
  for (flatbuffers::uoffset_t i = 0; i < table.along_m()->size(); ++i) {
    const std::string place = where + ", frame " + std::to_string(i);
    Result<DatabaseFrame> frame = frame_at(table, i, first, place);
    if (!frame) return frame.error();
    if (i > 0 && !(tile.frames.back().along_m < frame->along_m)) {
      return broken_tile(place, "along_m of the frames does not ascend", "4.7");
    }
    tile.frames.push_back(std::move(*frame));
    first += table.features()->Get(i);
  }
  return tile;
}

}  // namespace milepost
