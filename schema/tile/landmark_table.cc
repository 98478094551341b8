#include <algorithm>
#include <cmath>
#include <limits>

#include "schema/tile/columns.h"
#include "schema/tile/landmark_steps.h"
#include "schema/tile/landmark_tile_generated.h"
#include "schema/tile/table.h"

namespace milepost {
namespace {

constexpr const char* kNotLandmarks =
    "the content is not a valid FlatBuffer with the identifier MPL1";

constexpr std::int16_t LandmarkSteps::*kCoordinates[] = {
    &LandmarkSteps::east_cm, &LandmarkSteps::north_cm, &LandmarkSteps::up_cm};

std::vector<LandmarkSteps> all_steps_of(const LandmarkTile& tile) {
  std::vector<LandmarkSteps> all;
  all.reserve(tile.landmarks.size());
  for (const Landmark& landmark : tile.landmarks) {
    all.push_back(steps_of(landmark, tile.origin_m));
  }
  return all;
}

std::vector<std::int8_t> descriptor_planes(const std::vector<LandmarkSteps>& landmarks) {
  std::vector<std::int8_t> planes;
  planes.reserve(landmarks.size() * kCompactValues);
  for (std::size_t k = 0; k < kCompactValues; ++k) {
    for (const LandmarkSteps& landmark : landmarks) planes.push_back(landmark.descriptor[k]);
  }
  return planes;
}

// The bytes at bit `shift` of the coordinates.
Bytes position_planes(const std::vector<LandmarkSteps>& landmarks, int shift) {
  Bytes planes;
  planes.reserve(landmarks.size() * std::size(kCoordinates));
  for (const auto coordinate_cm : kCoordinates) {
    for (const LandmarkSteps& landmark : landmarks) {
      planes.push_back(static_cast<std::uint8_t>(landmark.*coordinate_cm >> shift));
    }
  }
  return planes;
}

// REQUIRES: the landmarks are sorted by where they begin.
std::vector<std::uint16_t> begins_after_the_one_before(
    const std::vector<LandmarkSteps>& landmarks) {
  std::uint16_t before_dm = 0;
  return column<std::uint16_t>(landmarks, [&before_dm](auto& landmark) {
    const auto after_dm = static_cast<std::uint16_t>(landmark.begin_dm - before_dm);
    before_dm = landmark.begin_dm;
    return after_dm;
  });
}

flatbuffers::Offset<fbs::LandmarkTile> build_table(flatbuffers::FlatBufferBuilder& builder,
                                                   const LandmarkTile& tile) {
  const std::vector<LandmarkSteps> landmarks = all_steps_of(tile);
  const auto bytes = [&](auto value_of) {
    return builder.CreateVector(column<std::uint8_t>(landmarks, value_of));
  };
  // Separate statements: the order of evaluation of arguments, and so of the bytes, is unspecified.
  // The last comes first in the bytes.
  const auto descriptors = builder.CreateVector(descriptor_planes(landmarks));
  const auto position_low = builder.CreateVector(position_planes(landmarks, 0));
  const auto position_high = builder.CreateVector(position_planes(landmarks, 8));
  const auto depth_sigma = bytes([](auto& landmark) { return landmark.depth_sigma; });
  const auto size = bytes([](auto& landmark) { return landmark.size; });
  const auto size_sigma = bytes([](auto& landmark) { return landmark.size_sigma; });
  const auto begin = builder.CreateVector(begins_after_the_one_before(landmarks));
  const auto length = builder.CreateVector(
      column<std::uint16_t>(landmarks, [](auto& landmark) { return landmark.length_dm; }));
  const auto observations = bytes([](auto& landmark) { return landmark.observations; });
  // Left out where each was seen by one drive.
  const bool is_fused = std::ranges::any_of(landmarks, [](auto& l) { return l.passes != 1; });
  const auto passes = is_fused ? bytes([](auto& landmark) { return landmark.passes; })
                               : flatbuffers::Offset<flatbuffers::Vector<std::uint8_t>>();
  // Left out where each was mapped from the line.
  const bool is_beside = std::ranges::any_of(landmarks, [](auto& l) { return l.right_dm != 0; });
  const auto right = is_beside ? builder.CreateVector(column<std::int8_t>(
                                     landmarks, [](auto& landmark) { return landmark.right_dm; }))
                               : flatbuffers::Offset<flatbuffers::Vector<std::int8_t>>();
  const auto segment = builder.CreateString(tile.segment);
  return fbs::CreateLandmarkTile(builder, segment, tile.index, tile.origin_m, kCompactValues,
                                 descriptors, position_low, position_high, depth_sigma, size,
                                 size_sigma, begin, length, observations, passes, right);
}

// Checks that every array has exactly one value per landmark.
Status check_arrays(const fbs::LandmarkTile& table, const std::string& where) {
  const std::size_t count = table.observations()->size();
  if (count > kMaxLandmarksPerTile) return broken_tile(where, "more than 65536 landmarks", "5.3");
  const Status lengths = check_lengths(where, {"observations", count},
                                       {
                                           {"depth_sigma", table.depth_sigma()->size()},
                                           {"size", table.size()->size()},
                                           {"size_sigma", table.size_sigma()->size()},
                                           {"begin_dm", table.begin_dm()->size()},
                                           {"length_dm", table.length_dm()->size()},
                                       },
                                       "5.3");
  if (!lengths.ok()) return lengths;
  if (table.passes() != nullptr && table.passes()->size() != count) {
    return broken_tile(where, "passes are not as many as observations", "5.10");
  }
  if (table.right_dm() != nullptr && table.right_dm()->size() != count) {
    return broken_tile(where, "right_dm are not as many as observations", "5.11");
  }
  if (table.descriptor_values() != kCompactValues) {
    return broken_tile(where, "a descriptor does not have 32 values", "5.4");
  }
  if (table.descriptors()->size() != count * kCompactValues) {
    return broken_tile(where, "the length of descriptors is not 32 times that of observations",
                       "5.4");
  }
  for (const auto* planes : {table.position_low(), table.position_high()}) {
    if (planes->size() == count * std::size(kCoordinates)) continue;
    return broken_tile(where, "the positions are not 3 times as many as observations", "5.5");
  }
  return ok_status();
}

// The landmark `i`. REQUIRES: check_arrays holds.
LandmarkSteps steps_at(const fbs::LandmarkTile& table, flatbuffers::uoffset_t i,
                       std::uint16_t begin_dm) {
  LandmarkSteps steps;
  const flatbuffers::uoffset_t count = table.observations()->size();
  for (flatbuffers::uoffset_t k = 0; k < kCompactValues; ++k) {
    steps.descriptor[k] = table.descriptors()->Get(k * count + i);
  }
  flatbuffers::uoffset_t at = i;
  for (const auto coordinate_cm : kCoordinates) {
    steps.*coordinate_cm = static_cast<std::int16_t>(table.position_low()->Get(at) |
                                                     table.position_high()->Get(at) << 8);
    at += count;
  }
  steps.depth_sigma = table.depth_sigma()->Get(i);
  steps.size = table.size()->Get(i);
  steps.size_sigma = table.size_sigma()->Get(i);
  steps.begin_dm = begin_dm;
  steps.length_dm = table.length_dm()->Get(i);
  steps.observations = table.observations()->Get(i);
  if (table.passes() != nullptr) steps.passes = table.passes()->Get(i);
  if (table.right_dm() != nullptr) steps.right_dm = table.right_dm()->Get(i);
  return steps;
}

Status check_landmark(const LandmarkSteps& steps, const std::string& where) {
  if (steps.size_sigma > kSizeSigmaUnits) {
    return broken_tile(where, "the size sigma is above 1", "5.6");
  }
  if (steps.observations < 3) return broken_tile(where, "fewer than 3 observations", "5.8");
  if (steps.passes == 0) return broken_tile(where, "no pass", "5.10");
  if (steps.right_dm < kLeastRightDm) return broken_tile(where, "right_dm is -128", "5.11");
  return ok_status();
}

}  // namespace

Bytes table_from_landmarks(const LandmarkTile& tile) {
  flatbuffers::FlatBufferBuilder builder;
  fbs::FinishSizePrefixedLandmarkTileBuffer(builder, build_table(builder, tile));
  return {builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize()};
}

std::vector<std::size_t> landmark_array_starts(ByteView bytes) {
  const fbs::LandmarkTile& table = *fbs::GetSizePrefixedLandmarkTile(bytes.data());
  const auto start_of = [&](const auto* array) {
    return static_cast<std::size_t>(array->Data() - bytes.data());
  };
  return {start_of(table.position_high()), start_of(table.position_low()),
          start_of(table.descriptors())};
}

Result<LandmarkTile> landmarks_from_table(ByteView bytes) {
  flatbuffers::Verifier verifier(bytes.data(), bytes.size());
  if (!fbs::VerifySizePrefixedLandmarkTileBuffer(verifier))
    return broken_tile("tile", kNotLandmarks, "5.2");
  const fbs::LandmarkTile& table = *fbs::GetSizePrefixedLandmarkTile(bytes.data());
  Status status = check_head(table.segment()->string_view(), table.origin_m());
  if (!status.ok()) return status.error();
  const std::string where = place_of(table);
  status = check_arrays(table, where);
  if (!status.ok()) return status.error();

  LandmarkTile tile{table.segment()->str(), table.index(), table.origin_m(), {}};
  const flatbuffers::uoffset_t count = table.observations()->size();
  tile.landmarks.reserve(count);
  std::uint32_t begin_dm = 0;
  for (flatbuffers::uoffset_t i = 0; i < count; ++i) {
    const std::string place = where + ", landmark " + std::to_string(i);
    begin_dm += table.begin_dm()->Get(i);
    if (begin_dm > std::numeric_limits<std::uint16_t>::max()) {
      return broken_tile(place, "it begins more than 6553.5 m after the origin", "5.7");
    }
    const LandmarkSteps steps = steps_at(table, i, static_cast<std::uint16_t>(begin_dm));
    status = check_landmark(steps, place);
    if (!status.ok()) return status.error();
    tile.landmarks.push_back(landmark_of(steps, tile.origin_m));
    if (!(tile.landmarks.back().along.to_m <= kMaxAlongM)) {
      return broken_tile(place, "the along range is out of range", "5.7");
    }
  }
  return tile;
}

}  // namespace milepost
