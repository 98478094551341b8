#include "schema/document/mapping_record.h"

#include <array>
#include <cmath>
#include <utility>

#include "schema/base/json.h"
#include "schema/document/canonical_json.h"

namespace milepost {
namespace {

using nlohmann::json;

constexpr std::array<std::pair<const char*, std::uint64_t PoseFit::*>, 3> kCounts = {
    {{"frames", &PoseFit::frames},
     {"followed", &PoseFit::followed},
     {"fitting", &PoseFit::fitting}}};
constexpr std::array<std::pair<const char*, double PoseFit::*>, 4> kErrors = {
    {{"reprojection_px", &PoseFit::reprojection_px},
     {"plan_rms_m", &PoseFit::plan_rms_m},
     {"up_rms_m", &PoseFit::up_rms_m},
     {"heading_rms_deg", &PoseFit::heading_rms_deg}}};
using FindingText = std::string RecordedFinding::*;
constexpr std::array<std::pair<const char*, FindingText>, 5> kFindingTexts = {
    {{"kind", &RecordedFinding::kind},
     {"drive", &RecordedFinding::drive},
     {"where", &RecordedFinding::where},
     {"what", &RecordedFinding::what},
     {"hint", &RecordedFinding::hint}}};

using CheckPointText = std::string CheckPointResidual::*;
constexpr std::array<std::pair<const char*, CheckPointText>, 2> kCheckPointTexts = {
    {{"mark", &CheckPointResidual::mark}, {"drive", &CheckPointResidual::drive}}};
constexpr std::array<std::pair<const char*, double CheckPointResidual::*>, 3> kCheckPointPlaces = {
    {{"latitude_deg", &CheckPointResidual::latitude_deg},
     {"longitude_deg", &CheckPointResidual::longitude_deg},
     {"altitude_m", &CheckPointResidual::altitude_m}}};
constexpr std::array<std::pair<const char*, double CheckPointResidual::*>, 4> kResiduals = {
    {{"east_m", &CheckPointResidual::east_m},
     {"north_m", &CheckPointResidual::north_m},
     {"up_m", &CheckPointResidual::up_m},
     {"reprojection_px", &CheckPointResidual::reprojection_px}}};

// To a tenth of a millimetre, or of a millidegree: more would be digits without a meaning.
double rounded(double value) { return std::round(value * 1e4) / 1e4; }

void add_fit(json& object, const PoseFit& fit) {
  for (const auto& [name, member] : kCounts) object[name] = fit.*member;
  for (const auto& [name, member] : kErrors) object[name] = rounded(fit.*member);
}

json stretch_json(const StretchFit& stretch) {
  json object = {{"from_m", stretch.from_m}, {"to_m", stretch.to_m}, {"drive", stretch.drive}};
  add_fit(object, stretch.fit);
  return object;
}

json finding_json(const RecordedFinding& finding) {
  json object = {{"row", finding.row}, {"count", finding.count}};
  for (const auto& [name, member] : kFindingTexts) object[name] = finding.*member;
  return object;
}

json check_point_json(const CheckPointResidual& point) {
  json object = {{"sights", point.sights}};
  for (const auto& [name, member] : kCheckPointTexts) object[name] = point.*member;
  for (const auto& [name, member] : kCheckPointPlaces) object[name] = point.*member;
  if (!point.is_placed) return object;
  for (const auto& [name, member] : kResiduals) object[name] = rounded(point.*member);
  return object;
}

// Takes members of objects; after the first that is missing or of another type it is not sound.
class Members {
 public:
  template <class Take>
  void each_of(const json& object, const char* name, Take take) {
    const auto list = object.is_object() ? object.find(name) : object.end();
    if (!object.is_object() || list == object.end() || !list->is_array()) return fail(name);
    for (const json& member : *list) {
      if (!member.is_object()) return fail(name);
      take(member);
    }
  }

  void text(const json& object, const char* name, std::string& value) {
    const auto member = object.find(name);
    if (member == object.end() || !member->is_string()) return fail(name);
    value = member->get<std::string>();
  }

  void count(const json& object, const char* name, std::uint64_t& value) {
    const auto member = object.find(name);
    if (member == object.end() || !member->is_number_unsigned()) return fail(name);
    value = member->get<std::uint64_t>();
  }

  void number(const json& object, const char* name, double& value) {
    const auto member = object.find(name);
    if (member == object.end() || !member->is_number()) return fail(name);
    value = member->get<double>();
  }

  void fit(const json& object, PoseFit& fit) {
    for (const auto& [name, member] : kCounts) count(object, name, fit.*member);
    for (const auto& [name, member] : kErrors) number(object, name, fit.*member);
  }

  bool are_sound() const { return wrong_.empty(); }
  const std::string& wrong() const { return wrong_; }

 private:
  void fail(const char* name) {
    if (wrong_.empty()) wrong_ = name;
  }

  std::string wrong_;
};

}  // namespace

std::string mapping_document(const MappingRecord& record) {
  json drives = json::array();
  for (const DriveFit& drive : record.drives) {
    drives.push_back({{"drive", drive.drive}});
    add_fit(drives.back(), drive.fit);
  }
  json segments = json::array();
  for (const auto& [id, stretches] : record.segments) {
    segments.push_back({{"segment", id}, {"stretches", json::array()}});
    for (const StretchFit& stretch : stretches)
      segments.back()["stretches"].push_back(stretch_json(stretch));
  }
  json findings = json::array();
  for (const RecordedFinding& finding : record.findings) findings.push_back(finding_json(finding));
  json document = {{"drives", std::move(drives)},
                   {"segments", std::move(segments)},
                   {"findings", std::move(findings)}};
  for (const CheckPointResidual& point : record.check_points)
    document["check_points"].push_back(check_point_json(point));
  return canonical_json(document);
}

Result<MappingRecord> mapping_record_from(std::string_view text) {
  const Result<json> root = read_json(text);
  const auto corrupt = [](const std::string& what) {
    return Error{ErrorCode::corrupt, "", "the record of its mapping: " + what,
                 "build the map anew"};
  };
  if (!root) return corrupt(root.error().what);
  MappingRecord record;
  Members members;
  members.each_of(*root, "drives", [&](const json& object) {
    DriveFit& drive = record.drives.emplace_back();
    members.text(object, "drive", drive.drive);
    members.fit(object, drive.fit);
  });
  members.each_of(*root, "segments", [&](const json& object) {
    std::string id;
    members.text(object, "segment", id);
    std::vector<StretchFit>& stretches = record.segments[id];
    members.each_of(object, "stretches", [&](const json& part) {
      StretchFit& stretch = stretches.emplace_back();
      members.number(part, "from_m", stretch.from_m);
      members.number(part, "to_m", stretch.to_m);
      members.text(part, "drive", stretch.drive);
      members.fit(part, stretch.fit);
    });
  });
  members.each_of(*root, "findings", [&](const json& object) {
    RecordedFinding& finding = record.findings.emplace_back();
    for (const auto& [name, member] : kFindingTexts) members.text(object, name, finding.*member);
    members.count(object, "row", finding.row);
    members.count(object, "count", finding.count);
  });
  if (root->contains("check_points")) {
    members.each_of(*root, "check_points", [&](const json& object) {
      CheckPointResidual& point = record.check_points.emplace_back();
      for (const auto& [name, member] : kCheckPointTexts) members.text(object, name, point.*member);
      for (const auto& [name, member] : kCheckPointPlaces)
        members.number(object, name, point.*member);
      members.count(object, "sights", point.sights);
      point.is_placed = object.contains("east_m");
      if (!point.is_placed) return;
      for (const auto& [name, member] : kResiduals) members.number(object, name, point.*member);
    });
  }
  if (!members.are_sound()) return corrupt("\"" + members.wrong() + "\" is missing or malformed");
  return record;
}

}  // namespace milepost
