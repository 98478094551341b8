#include "mapper/findings/witness_findings.h"

#include "schema/base/digits.h"

namespace milepost {

std::vector<Finding> witness_findings(const std::string& drive_folder,
                                      const ImageWitness& witness) {
  constexpr double kMaxPlanM = 0.15;
  constexpr double kMaxUpM = 0.15;
  constexpr double kMaxHeadingDeg = 3;
  constexpr double kLeastFitting = 0.7;
  std::vector<Finding> findings;
  const auto tell = [&](bool is_found, const std::string& kind, const std::string& what,
                        const std::string& hint) {
    if (is_found) findings.push_back({kind, drive_folder, 0, witness.frames, what, hint});
  };
  const std::string mended = ", which the map takes from the images";
  tell(witness.plan_rms_m() > kMaxPlanM, "images_against_positions",
       "the images place the camera " + fixed(witness.plan_rms_m(), 2) +
           " m beside the recorded positions from frame to frame" + mended,
       "record positions with a better receiver, or smooth them; do images and poses have one "
       "clock?");
  tell(witness.up_rms_m() > kMaxUpM, "images_against_altitudes",
       "the images place the camera " + fixed(witness.up_rms_m(), 2) +
           " m above or below the recorded altitudes from frame to frame" + mended,
       "smooth the altitudes");
  tell(witness.heading_rms_deg() > kMaxHeadingDeg, "images_against_headings",
       "the images turn the camera " + fixed(witness.heading_rms_deg(), 1) +
           " degrees from the recorded headings from frame to frame" + mended,
       "record the camera's headings, not the course of a receiver");
  tell(witness.fitting_share() < kLeastFitting, "poor_fit",
       "only " + fixed(100 * witness.fitting_share(), 0) +
           " % of the features that were followed fit any poses near the recorded ones",
       "check focal length, distortion and mounting of the camera, and the clocks");
  return findings;
}

}  // namespace milepost
