// What all threads of a server use together.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "server/access/access.h"
#include "server/catalog/current_catalog.h"
#include "server/channel/tls_context.h"
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
  // `completed`: the limits of `settings`, completed. REQUIRES: no limit is 0.
  Shared(std::shared_ptr<const CurrentCatalog> served, const ServerSettings& settings,
         const ConnectionLimits& completed)
      : catalog(std::move(served)),
        viewer(settings.viewer),
        tls(settings.tls),
        allowed_origins(settings.allowed_origins),
        access(settings.tokens, settings.rate),
        limits(completed),
        admission(completed.connections, completed.per_address),
        answers(settings.hot_bytes / 4),
        frames(settings.hot_bytes - settings.hot_bytes / 4),
        disk(settings.disk_threads, settings.disk_queue) {}

  const std::shared_ptr<const CurrentCatalog> catalog;
  Metrics metrics{path_patterns()};
  const std::shared_ptr<const Viewer> viewer;   // null: with a plain ground
  const std::shared_ptr<const CurrentTls> tls;  // null: without
  std::atomic<std::uint64_t> failed_handshakes = 0;
  const std::vector<std::string> allowed_origins;  // whose pages may read what is sent
  Access access;
  const ConnectionLimits limits;
  Admission admission;
  HotAnswers answers;
  HotFrames frames;
  DiskPool disk;
};

}  // namespace milepost::server
