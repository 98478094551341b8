// The walls of one block of an orthoimage.
#pragma once

#include "mapper/aerial/extraction.h"
#include "mapper/aerial/stage_pictures.h"

namespace milepost {

// Properties of the whole image, determined before its blocks are processed.
struct ImageLight {
  Sun sun;
  double shadow_threshold = 0;  // grey value
};

// The lines of the block, in its frame, before merging and closure. Safe from several threads.
WallLines block_walls(const Picture& picture, const ImageLight& light,
                      const ExtractionSettings& settings, const StagePictures& pictures);

}  // namespace milepost
