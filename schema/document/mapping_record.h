// How a map came to be: what the images of its drives say of the recorded poses, and the findings
// of the build (FORMAT.md 7.6). No vehicle needs it; who accepts a map does.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "schema/base/result.h"

namespace milepost {

// Of some frames of one drive: root mean squares of how far the adjusted poses are from the
// recorded ones, and of the reprojection errors of the features that fit them.
struct PoseFit {
  std::uint64_t frames = 0;    // that were adjusted
  std::uint64_t followed = 0;  // features, with a place in space ...
  std::uint64_t fitting = 0;   // ... of which these fit
  double reprojection_px = 0;
  double plan_rms_m = 0;
  double up_rms_m = 0;
  double heading_rms_deg = 0;

  friend bool operator==(const PoseFit&, const PoseFit&) = default;
};

struct DriveFit {
  std::string drive;  // its name
  PoseFit fit;

  friend bool operator==(const DriveFit&, const DriveFit&) = default;
};

inline constexpr double kStretchM = 10;

// A drive's frames on [from_m, to_m] of a segment, kStretchM long.
struct StretchFit {
  double from_m = 0;
  double to_m = 0;
  std::string drive;
  PoseFit fit;

  friend bool operator==(const StretchFit&, const StretchFit&) = default;
};

// As Finding, but without paths: `where` is a file of the drive or a place on it.
struct RecordedFinding {
  std::string kind;
  std::string drive;  // empty: of no single drive
  std::string where;
  std::string what;
  std::string hint;
  std::uint64_t row = 0;  // of the file; 0: of none
  std::uint64_t count = 0;

  friend bool operator==(const RecordedFinding&, const RecordedFinding&) = default;
};

// Where the map has a surveyed mark, by the images of one drive.
struct CheckPointResidual {
  std::string mark;
  std::string drive;
  double latitude_deg = 0;  // as it was surveyed
  double longitude_deg = 0;
  double altitude_m = 0;
  std::uint64_t sights = 0;  // in frames that were mapped
  bool is_placed = false;    // otherwise they are too few, or look from one direction
  double east_m = 0;         // from there to where the map has it
  double north_m = 0;
  double up_m = 0;
  double reprojection_px = 0;

  friend bool operator==(const CheckPointResidual&, const CheckPointResidual&) = default;
};

struct MappingRecord {
  std::vector<DriveFit> drives;                             // by name
  std::map<std::string, std::vector<StretchFit>> segments;  // by id; by drive and place
  std::vector<RecordedFinding> findings;
  std::vector<CheckPointResidual> check_points = {};

  friend bool operator==(const MappingRecord&, const MappingRecord&) = default;
};

std::string mapping_document(const MappingRecord& record);

// Errors: corrupt, with `where` empty.
Result<MappingRecord> mapping_record_from(std::string_view text);

}  // namespace milepost
