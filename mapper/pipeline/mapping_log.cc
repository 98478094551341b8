#include "mapper/pipeline/mapping_log.h"

#include <algorithm>
#include <cmath>

namespace milepost {
namespace {

PoseFit fit_of(const ImageWitness& witness) {
  return {witness.frames,           witness.tracks,
          witness.fitting,          witness.reprojection_rms_px(),
          witness.plan_rms_m(),     witness.up_rms_m(),
          witness.heading_rms_deg()};
}

void replace_all(std::string& text, const std::string& old, const std::string& by) {
  for (std::size_t at = text.find(old); at != std::string::npos;
       at = text.find(old, at + by.size()))
    text.replace(at, old.size(), by);
}

// The folder at the begin of `where` becomes the name of the drive.
RecordedFinding recorded(const Finding& finding, const std::vector<const Drive*>& drives) {
  RecordedFinding record{finding.kind, "",           finding.where, finding.what,
                         finding.hint, finding.line, finding.count};
  // The longest folder first: one may begin as another does.
  std::vector<const Drive*> longest = drives;
  std::ranges::stable_sort(longest, std::ranges::greater(),
                           [](const Drive* drive) { return drive->folder.string().size(); });
  for (const Drive* drive : longest) {
    const std::string folder = drive->folder.string();
    if (record.drive.empty() && record.where.starts_with(folder)) {
      record.drive = drive->name;
      record.where.erase(0, folder.size());
      const std::size_t begin = record.where.find_first_not_of("/, ");
      record.where.erase(0, std::min(begin, record.where.size()));
    }
    for (std::string* text : {&record.where, &record.what, &record.hint})
      replace_all(*text, folder, drive->name);
  }
  return record;
}

}  // namespace

void MappingLog::add(const Drive& drive, const WitnessedPlace& place) {
  drives_[drive.name] += place.witness;
  if (place.segment.empty()) return;
  const auto number = static_cast<int>(std::floor(std::max(0.0, place.along_m) / kStretchM));
  segments_[place.segment][{drive.name, number}] += place.witness;
}

ImageWitness MappingLog::of_drive(const std::string& drive) const {
  const auto known = drives_.find(drive);
  return known == drives_.end() ? ImageWitness() : known->second;
}

void MappingLog::add(const std::vector<Finding>& findings,
                     const std::vector<const Drive*>& drives) {
  for (const Finding& finding : findings) findings_.push_back(recorded(finding, drives));
  // Whatever the order in which the drives were given.
  std::ranges::stable_sort(findings_, {}, &RecordedFinding::drive);
}

MappingRecord MappingLog::record_of(const std::set<std::string>& segments) const {
  MappingRecord record;
  for (const auto& [drive, witness] : drives_) record.drives.push_back({drive, fit_of(witness)});
  for (const auto& [segment, stretches] : segments_) {
    if (!segments.contains(segment)) continue;
    for (const auto& [stretch, witness] : stretches) {
      const double from_m = stretch.second * kStretchM;
      record.segments[segment].push_back(
          {from_m, from_m + kStretchM, stretch.first, fit_of(witness)});
    }
  }
  record.findings = findings_;
  record.check_points = check_points_;
  return record;
}

}  // namespace milepost
