// Small drives with images that nothing is on but noise.
#pragma once

#include <filesystem>
#include <string>

#include "schema/drive/drive.h"

namespace milepost::testing {

// A drive of `frames` frames of blurred noise, 2 m apart to the north; grey values from 0 to
// `brightest`.
Drive noise_drive(const std::filesystem::path& folder, const std::string& name, int frames,
                  int seed, int brightest = 255);

}  // namespace milepost::testing
