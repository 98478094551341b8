// Collects what is to be recorded of a mapping: how well the images of each drive fit its poses, on
// each stretch of each segment, and the findings.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mapper/findings/finding.h"
#include "mapper/landmarks/image_witness.h"
#include "mapper/pipeline/landmark_survey.h"
#include "schema/document/mapping_record.h"
#include "schema/drive/drive.h"

namespace milepost {

class MappingLog {
 public:
  void add(const Drive& drive, const WitnessedPlace& place);
  // Of the whole drive so far.
  ImageWitness of_drive(const std::string& drive) const;
  // With names of drives in the place of their folders: the record does not depend on paths.
  void add(const std::vector<Finding>& findings, const std::vector<const Drive*>& drives);

  void set_check_points(std::vector<CheckPointResidual> residuals) {
    check_points_ = std::move(residuals);
  }

  // What concerns the segments whose ids are given.
  MappingRecord record_of(const std::set<std::string>& segments) const;

 private:
  using Stretch = std::pair<std::string, int>;  // drive, number of the stretch

  std::map<std::string, ImageWitness> drives_;
  std::map<std::string, std::map<Stretch, ImageWitness>> segments_;
  std::vector<RecordedFinding> findings_;
  std::vector<CheckPointResidual> check_points_;
};

}  // namespace milepost
