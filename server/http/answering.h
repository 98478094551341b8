// From a request to an answer, from memory or from the disk.
#pragma once

#include <vector>

#include "server/hot/hot_frames.h"
#include "server/hot/prepared.h"
#include "server/http/shared.h"
#include "server/message/request.h"

namespace milepost::server {

struct Answer {
  PreparedAnswer prepared;
  std::vector<Frame>
      frames;  // the first ones of the body, also to HEAD: what cannot be read is 500
  std::shared_ptr<const ServedMap> map;  // of the body's frames; null without
};

// The answer, if it and the first frame of its body are in memory; else without `prepared`. Never
// blocks. HotAnswers know nothing of fields of a request and of its grant: what changes an answer
// is applied here and in answer_from_disk.
Answer answer_from_memory(const Request& request, const Grant& grant, Shared& shared);

// Any answer, which enters the memory. May take as long as the disk takes.
Answer answer_from_disk(const Request& request, const Grant& grant, Shared& shared);

}  // namespace milepost::server
