#include "mapper/findings/datum_findings.h"

#include "schema/drive/description.h"

namespace milepost {
namespace {

std::string description_of(const Drive& drive) {
  return (drive.folder / kDescriptionFile).string();
}

// The first by name of those that state a datum.
const Drive* first_stating(const std::vector<Drive>& drives) {
  const Drive* first = nullptr;
  for (const Drive& drive : drives) {
    if (drive.datum.is_stated() && (first == nullptr || drive.name < first->name)) first = &drive;
  }
  return first;
}

}  // namespace

Result<Datum> common_datum(const std::vector<Drive>& drives) {
  const Drive* first = first_stating(drives);
  if (first == nullptr) return Datum();
  for (const Drive& drive : drives) {
    const Status agrees =
        check_agree(drive.datum, description_of(drive), first->datum, description_of(*first));
    if (!agrees) return agrees.error();
  }
  return first->datum;
}

std::vector<Finding> datum_findings(const std::vector<Drive>& drives) {
  const Drive* first = first_stating(drives);
  std::vector<Finding> findings;
  if (first == nullptr) return findings;
  for (const Drive& drive : drives) {
    if (drive.datum.is_stated()) continue;
    findings.push_back({"datum_not_stated", description_of(drive), 0, drive.frames.size(),
                        "it does not state the datum of its positions, as " +
                            description_of(*first) + " does; they are taken for " +
                            first->datum.text(),
                        "write its datum"});
  }
  return findings;
}

}  // namespace milepost
