#include "mapper/pipeline/recordings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "mapper/findings/rounded_positions.h"
#include "schema/base/file.h"
#include "schema/base/median.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr double kSameTimeS = 1e-3;
constexpr double kSamePart = 0.9;  // of the frames of the shorter of two recordings of one run

using FramePairs = std::vector<std::pair<std::size_t, std::size_t>>;

// Frames of the same time, by their numbers in `a` and `b`, given ascending.
FramePairs at_one_time(const Drive& a, const std::vector<std::size_t>& of_a, const Drive& b,
                       const std::vector<std::size_t>& of_b) {
  FramePairs pairs;
  for (std::size_t i = 0, j = 0; i < of_a.size() && j < of_b.size();) {
    const double later_s = b.frames[of_b[j]].timestamp_s - a.frames[of_a[i]].timestamp_s;
    if (std::abs(later_s) <= kSameTimeS) {
      pairs.emplace_back(i++, j++);
    } else {
      ++(later_s > 0 ? i : j);
    }
  }
  return pairs;
}

std::vector<std::size_t> all_frames(const Drive& drive) {
  std::vector<std::size_t> frames(drive.frames.size());
  std::iota(frames.begin(), frames.end(), std::size_t{0});
  return frames;
}

// The place of a camera as another one's vehicle sees it: forward, right, up.
Eigen::Vector3d offset_m(const Frame& of, const Frame& seen_from) {
  const EnuPoint enu = LocalFrame(seen_from.position).enu_from_geo(of.position);
  const double heading_rad = seen_from.heading_deg * kRadPerDeg;
  const double sine = std::sin(heading_rad);
  const double cosine = std::cos(heading_rad);
  return {enu.east_m * sine + enu.north_m * cosine, enu.east_m * cosine - enu.north_m * sine,
          enu.up_m};
}

// Whether most of the pairs are in one place but for an offset of two cameras on one vehicle.
// Receivers of two vehicles differ by more than this from frame to frame, and so do positions of
// one receiver that were computed twice.
bool is_one_way(const Drive& a, const std::vector<std::size_t>& of_a, const Drive& b,
                const std::vector<std::size_t>& of_b, const FramePairs& pairs, double baseline_m) {
  constexpr double kSameOffsetM = 0.01;
  const std::size_t frames = std::min(of_a.size(), of_b.size());
  const auto needed = kSamePart * static_cast<double>(frames);
  if (frames == 0 || static_cast<double>(pairs.size()) < needed) return false;
  std::vector<Eigen::Vector3d> offsets;
  offsets.reserve(pairs.size());
  for (const auto& [i, j] : pairs)
    offsets.push_back(offset_m(b.frames[of_b[j]], a.frames[of_a[i]]));
  Eigen::Vector3d usual;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    values.reserve(offsets.size());
    for (const Eigen::Vector3d& offset : offsets) values.push_back(offset[axis]);
    usual[axis] = median_of(std::move(values));
  }
  if (usual.norm() > baseline_m) return false;
  const auto same = std::ranges::count_if(offsets, [&](const Eigen::Vector3d& offset) {
    return (offset - usual).norm() <= kSameOffsetM;
  });
  return static_cast<double>(same) >= needed;
}

// Some images of the pairs, byte by byte.
bool have_the_same_images(const Drive& a, const std::vector<std::size_t>& of_a, const Drive& b,
                          const std::vector<std::size_t>& of_b, const FramePairs& pairs) {
  const auto bytes = [](const Drive& drive, std::size_t frame) {
    return read_text_file(drive.frame_path(drive.frames[frame]));
  };
  const std::array<std::size_t, 3> some = {0, pairs.size() / 2, pairs.size() - 1};
  return std::ranges::all_of(some, [&](std::size_t at) {
    const auto image_a = bytes(a, of_a[pairs[at].first]);
    const auto image_b = bytes(b, of_b[pairs[at].second]);
    return image_a && image_b && *image_a == *image_b;
  });
}

// Whether `a` has the frames of `b`.
bool has_frames_of(const Drive& a, const Drive& b) {
  const std::vector<std::size_t> of_a = all_frames(a);
  const std::vector<std::size_t> of_b = all_frames(b);
  if (of_b.size() > of_a.size()) return false;
  const FramePairs pairs = at_one_time(a, of_a, b, of_b);
  constexpr double kSameCameraM = 0.001;
  return is_one_way(a, of_a, b, of_b, pairs, kSameCameraM) &&
         have_the_same_images(a, of_a, b, of_b, pairs);
}

struct PlannedStretch {
  const Drive* drive;
  const StretchPlan* plan;
};

// The way of `b` as a way of stretch number `number`, which is `a`.
std::optional<DrivenStretch::SameWay> same_way(const PlannedStretch& a, const PlannedStretch& b,
                                               std::size_t number) {
  constexpr double kVehicleM = 3;  // across it
  const auto& of_a = a.plan->frame_indices;
  const auto& of_b = b.plan->frame_indices;
  if (a.drive == b.drive || of_b.size() > of_a.size()) return std::nullopt;
  const FramePairs pairs = at_one_time(*a.drive, of_a, *b.drive, of_b);
  if (pairs.size() < 2) return std::nullopt;
  if (!is_one_way(*a.drive, of_a, *b.drive, of_b, pairs, kVehicleM)) return std::nullopt;
  // Images that were placed twice, in different places, have two errors.
  if (have_the_same_images(*a.drive, of_a, *b.drive, of_b, pairs)) return std::nullopt;
  const auto& along_a = a.plan->line.along_m();
  const auto& along_b = b.plan->line.along_m();
  return DrivenStretch::SameWay{number,
                                {along_b[pairs.front().second], along_b[pairs.back().second]},
                                {along_a[pairs.front().first], along_a[pairs.back().first]}};
}

// Each stretch that has the way of another, with that way.
std::map<std::size_t, DrivenStretch::SameWay> same_ways(
    const std::vector<PlannedStretch>& planned) {
  std::vector<std::size_t> by_length(planned.size());
  std::iota(by_length.begin(), by_length.end(), std::size_t{0});
  std::ranges::stable_sort(by_length, std::ranges::greater(), [&](std::size_t stretch) {
    return planned[stretch].plan->frame_indices.size();
  });
  std::map<std::size_t, DrivenStretch::SameWay> same;
  std::vector<std::size_t> own;  // stretches with a way of their own
  for (const std::size_t stretch : by_length) {
    for (const std::size_t other : own) {
      const auto way = same_way(planned[other], planned[stretch], other);
      if (!way) continue;
      same.emplace(stretch, *way);
      break;
    }
    if (!same.contains(stretch)) own.push_back(stretch);
  }
  return same;
}

// What a drive states: its frames, if they do.
std::optional<double> stated_sigma_m(const Drive& drive) {
  if (drive.frames.empty() || !drive.frames.front().position_sigma_m)
    return drive.position_error.sigma_m;
  double squares = 0;
  for (const Frame& frame : drive.frames)
    squares += std::pow(frame.position_sigma_m.value_or(0), 2);
  return std::sqrt(squares / static_cast<double>(drive.frames.size()));
}

// What is known of a drive's sigma: what it states, or the usual one, is not all if its positions
// are rounded.
std::optional<double> known_sigma_m(const Drive& drive, const SlowErrorSettings& settings) {
  const std::optional<double> stated_m = stated_sigma_m(drive);
  const double rounding_m = rounding_step_m(drive) / std::sqrt(12.0);  // of a uniform distribution
  if (rounding_m == 0) return stated_m;
  const double usual_m = std::hypot(settings.bias_sigma_m, settings.drift_sigma_m);
  return std::hypot(stated_m.value_or(usual_m), rounding_m);
}

// What frames state at a stretch's nodes, relative to the whole drive.
std::vector<double> factors_of(const PlannedStretch& stretch, const SlowErrorSettings& settings) {
  const Drive& drive = *stretch.drive;
  const std::optional<double> usual_m = stated_sigma_m(drive);
  if (drive.frames.empty() || !drive.frames.front().position_sigma_m || *usual_m == 0) return {};
  const std::vector<double>& along_m = stretch.plan->line.along_m();
  std::vector<double> factors;
  for (std::size_t k = 0; k < node_count(stretch.plan->line.length_m(), settings); ++k) {
    const double at_m = static_cast<double>(k) * settings.node_spacing_m;
    const auto after = std::ranges::lower_bound(along_m, at_m);
    const std::size_t vertex =
        std::min(static_cast<std::size_t>(after - along_m.begin()), along_m.size() - 1);
    const Frame& frame = drive.frames[stretch.plan->frame_indices[vertex]];
    factors.push_back(frame.position_sigma_m.value_or(*usual_m) / *usual_m);
  }
  return factors;
}

}  // namespace

std::vector<const Drive*> without_copies(const std::vector<const Drive*>& drives,
                                         std::vector<Finding>& findings) {
  std::vector<const Drive*> by_length = drives;
  std::ranges::stable_sort(by_length, std::ranges::greater(),
                           [](const Drive* drive) { return drive->frames.size(); });
  std::vector<const Drive*> kept;
  for (const Drive* drive : by_length) {
    const auto original = std::ranges::find_if(
        kept, [&](const Drive* other) { return has_frames_of(*other, *drive); });
    if (original == kept.end()) {
      kept.push_back(drive);
      continue;
    }
    findings.push_back(
        {"copied_drive", "drive '" + drive->name + "'", 0, drive->frames.size(),
         "its frames are those of drive '" + (*original)->name + "', so it is left out",
         "a recording that is given twice tells nothing new"});
  }
  std::ranges::sort(kept, {}, &Drive::name);
  return kept;
}

RecordedErrors recorded_errors(const BuildPlan& plan, const SlowErrorSettings& settings) {
  RecordedErrors errors;
  std::map<std::string, std::size_t> groups;
  for (std::size_t d = 0; d < plan.drives.size(); ++d) {
    const Drive& drive = *plan.drives[d].drive;
    const std::string& group = drive.position_error.group;
    const std::size_t bias = group.empty() ? d : groups.try_emplace(group, d).first->second;
    errors.drives.push_back({.bias = bias,
                             .sigma_m = known_sigma_m(drive, settings),
                             .sigma_is_assumed = !stated_sigma_m(drive),
                             .correlation_m = drive.position_error.correlation_m});
  }
  std::vector<PlannedStretch> planned;
  for (std::size_t d = 0; d < plan.drives.size(); ++d) {
    for (const StretchPlan& stretch : plan.drives[d].stretches) {
      planned.push_back({plan.drives[d].drive, &stretch});
      errors.stretches.push_back({.drive = d,
                                  .length_m = stretch.line.length_m(),
                                  .sigma_factors = factors_of(planned.back(), settings)});
    }
  }
  for (const auto& [stretch, same] : same_ways(planned)) {
    errors.stretches[stretch].same_way = same;
    const std::size_t from = errors.drives[errors.stretches[stretch].drive].bias;
    const std::size_t to = errors.drives[errors.stretches[same.stretch].drive].bias;
    for (DriveErrors& drive : errors.drives) {
      if (drive.bias == from) drive.bias = to;
    }
  }
  return errors;
}

}  // namespace milepost
