// Whether an encoded image is whole. Decoders fill in what a file cut short lacks, or complain on
// standard error by themselves; a drive's reader wants neither.
#pragma once

#include "schema/base/bytes.h"

namespace milepost {

// Whether a JPEG or PNG lacks its end. False for any other format: its decoder has to tell.
bool is_cut_short(ByteView image);

}  // namespace milepost
