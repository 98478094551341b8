// What a drive's images say against its poses, once it has been mapped.
#pragma once

#include <string>
#include <vector>

#include "mapper/findings/finding.h"
#include "mapper/landmarks/adjustment.h"

namespace milepost {

// Kinds: images_against_positions, images_against_altitudes, images_against_headings, poor_fit.
std::vector<Finding> witness_findings(const std::string& drive_folder, const ImageWitness& witness);

}  // namespace milepost
