// The images of a recording in the folder of a drive.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mapper/import/recording.h"
#include "schema/base/result.h"

namespace milepost {

// Names that a drive's table can hold; of images in several folders, numbers.
std::vector<std::string> frame_names(const std::vector<RecordedImage>& images);

enum class PlaceImages { refer, copy, move };  // by symbolic links

// Errors: io, those of the container.
Status place_images(const std::vector<RecordedImage>& images, const std::vector<std::string>& names,
                    ImageContainer* container, PlaceImages how,
                    const std::filesystem::path& folder);

// Writes all images of a container into the folder, and makes them files of it. Errors: the same.
Status extract_images(Recording& recording, const std::filesystem::path& folder);

}  // namespace milepost
