#include "mapper/findings/drive_findings.h"

#include <atomic>
#include <thread>

#include "mapper/findings/datum_findings.h"
#include "mapper/findings/heading_findings.h"
#include "mapper/findings/image_findings.h"
#include "mapper/findings/position_findings.h"

namespace milepost {

Result<std::vector<Finding>> drive_findings(const Drive& drive) {
  const std::vector<Step> steps = steps_of(drive);
  std::vector<Finding> findings = position_findings(drive, steps);
  const std::vector<Finding> headings = heading_findings(drive, steps);
  findings.insert(findings.end(), headings.begin(), headings.end());
  const Result<std::vector<Finding>> images = image_findings(drive, steps);
  if (!images) return images.error();
  findings.insert(findings.end(), images->begin(), images->end());
  return findings;
}

Result<std::vector<Finding>> drive_findings(const std::vector<Drive>& drives, int threads) {
  std::vector<Result<std::vector<Finding>>> of_drives(drives.size(), std::vector<Finding>());
  std::atomic<std::size_t> next = 0;
  {
    std::vector<std::jthread> workers;
    workers.reserve(static_cast<std::size_t>(threads));
    for (int i = 0; i < threads; ++i) {
      workers.emplace_back([&] {
        for (std::size_t d = next++; d < drives.size(); d = next++)
          of_drives[d] = drive_findings(drives[d]);
      });
    }
  }
  std::vector<Finding> findings;
  for (const auto& of_drive : of_drives) {
    if (!of_drive) return of_drive.error();
    findings.insert(findings.end(), of_drive->begin(), of_drive->end());
  }
  const std::vector<Finding> of_datum = datum_findings(drives);
  findings.insert(findings.end(), of_datum.begin(), of_datum.end());
  return findings;
}

}  // namespace milepost
