// The kind of items in the tiles of a layer, as named in the layer's parameters (FORMAT.md 2.4).
#pragma once

#include <optional>
#include <string_view>

namespace milepost {

enum class LayerItems { tracklets, observations, frames, landmarks };

const char* name_of(LayerItems items);
std::optional<LayerItems> layer_items_named(std::string_view name);

}  // namespace milepost
