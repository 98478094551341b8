// Extracts the walls of buildings from an orthoimage: the stages of the aerial paper's section II,
// and our own stage of roofs.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include "mapper/aerial/closure.h"
#include "mapper/aerial/clutter.h"
#include "mapper/aerial/corners.h"
#include "mapper/aerial/edge_maps.h"
#include "mapper/aerial/ground_frame.h"
#include "mapper/aerial/merging.h"
#include "mapper/aerial/orthoimage.h"
#include "mapper/aerial/progressive_hough.h"
#include "mapper/aerial/regions.h"
#include "mapper/aerial/roofs.h"
#include "mapper/aerial/shadows.h"
#include "mapper/aerial/sun.h"
#include "schema/base/cell_grid.h"
#include "schema/base/result.h"

namespace milepost {

// Stages that can be disabled, for ablation.
enum class Stage {
  shadows,      // keeps edges at far borders of shadows
  vegetation,   // keeps clutter
  progressive,  // OpenCV's transform of one edge map instead of the progressive one of several
  merging,
  closure,
  corners,  // leaves ends of walls where their edges end
  roofs     // keeps lines that are not at a roof's edge
};

struct ExtractionSettings {
  double metres_per_pixel = 0.1;
  double block_m = 200;  // length of the sides of blocks
  double margin_m = 40;  // overlap with neighbour blocks: most of a large building
  std::set<Stage> without;
  std::optional<double> sun_azimuth_deg;    // none: estimated from the shadows
  std::optional<double> sun_elevation_deg;  // none: 45
  EdgeSettings edges;
  ShadowSettings shadows;
  ClutterSettings clutter;
  HoughSettings hough;
  MergingSettings merging;
  ClosureSettings closure;
  CornerSettings corners;
  RegionSettings regions;
  RoofSettings roofs;
  RoofEdgeSettings roof_edges;
};

struct ExtractionProgress {
  std::size_t blocks_done = 0;
  std::size_t blocks_total = 0;
};

struct ExtractedWalls {
  GroundFrame frame;
  Bounds bounds;  // of the image
  ImageBands bands;
  bool shows_anything = false;  // not the whole image is transparent
  WallLines lines;
  Sun sun;
  bool sun_was_estimated = false;
  double shadow_threshold = 0;  // grey value
};

// Reads the image in overlapping blocks, so that memory depends on their size and on the number of
// walls, not on the image; pieces of one line from two blocks are joined. The walls do not depend
// on `jobs`, the number of threads. If `pictures` names an existing folder, each stage of each
// block is drawn there. `on_progress` is called from one thread at a time; the result is
// `cancelled` once it returns false. Errors: those of Orthoimage; io; cancelled.
Result<ExtractedWalls> extract_walls(
    const ImageSource& source, const ExtractionSettings& settings, int jobs,
    const std::filesystem::path& pictures,
    const std::function<bool(const ExtractionProgress&)>& on_progress);

}  // namespace milepost
