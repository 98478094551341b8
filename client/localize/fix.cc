#include "client/localize/fix.h"

namespace milepost {

const char* name_of(FixStatus status) {
  switch (status) {
    case FixStatus::initializing:
      return "initializing";
    case FixStatus::tracking:
      return "tracking";
    case FixStatus::predicted:
      return "predicted";
    case FixStatus::lost:
      return "lost";
    case FixStatus::off_map:
      return "off-map";
  }
  return "";
}

}  // namespace milepost
