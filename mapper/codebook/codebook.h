// The codebook (a PCA projection with a quantization step) that compacts a map's descriptors.
#pragma once

#include <filesystem>
#include <string>

#include "schema/feature/pca_projection.h"

namespace milepost {

// The one that ships with milepost: maps made with it can be neighbours, and a drive that is added
// elsewhere changes no tile. Trained on frames of a simulated town.
const PcaProjection& shipped_codebook();

// A codebook file: a JSON object (FORMAT.md 5.9). Errors: not_found, io, corrupt.
Result<PcaProjection> read_codebook(const std::filesystem::path& file);
std::string codebook_text(const PcaProjection& codebook);

}  // namespace milepost
