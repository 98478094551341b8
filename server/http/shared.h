// What all threads of a server use together.
#pragma once

#include <cstddef>
#include <memory>

#include "server/catalog/current_catalog.h"
#include "server/hot/hot_answers.h"
#include "server/hot/hot_frames.h"
#include "server/http/disk_pool.h"
#include "server/http/settings.h"
#include "server/listen/admission.h"
#include "server/metrics/metrics.h"
#include "server/routes/handle.h"
#include "server/viewer/viewer.h"

namespace milepost::server {

struct Shared {
  // `page`: null for a plain one. `hot_bytes`: for tiles, cells and answers together. REQUIRES: no
  // limit is 0.
  Shared(std::shared_ptr<const CurrentCatalog> served, std::shared_ptr<const Viewer> page,
         const ConnectionLimits& chosen, std::size_t hot_bytes, unsigned disk_threads,
         std::size_t disk_queue)
      : catalog(std::move(served)),
        viewer(std::move(page)),
        limits(chosen),
        admission(chosen.connections, chosen.per_address),
        answers(hot_bytes / 4),
        frames(hot_bytes - hot_bytes / 4),
        disk(disk_threads, disk_queue) {}

  const std::shared_ptr<const CurrentCatalog> catalog;
  Metrics metrics{path_patterns()};
  const std::shared_ptr<const Viewer> viewer;
  const ConnectionLimits limits;
  Admission admission;
  HotAnswers answers;
  HotFrames frames;
  DiskPool disk;
};

}  // namespace milepost::server
