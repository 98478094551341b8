#include "schema/tile/layer_items.h"

namespace milepost {

const char* name_of(LayerItems items) {
  switch (items) {
    case LayerItems::tracklets:
      return "tracklets";
    case LayerItems::observations:
      return "observations";
    case LayerItems::frames:
      return "frames";
    case LayerItems::landmarks:
      return "landmarks";
  }
  return "";
}

std::optional<LayerItems> layer_items_named(std::string_view name) {
  for (const LayerItems items : {LayerItems::tracklets, LayerItems::observations,
                                 LayerItems::frames, LayerItems::landmarks}) {
    if (name == name_of(items)) return items;
  }
  return std::nullopt;
}

}  // namespace milepost
