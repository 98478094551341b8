// Accessors of a report's data.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "schema/page/report_json.h"

namespace milepost::testing {

// The parts, including those in groups.
inline std::vector<Json> parts_of(const Json& page) {
  std::vector<Json> parts;
  for (const Json& part : page["parts"]) {
    parts.push_back(part);
    if (!part.contains("parts")) continue;
    for (const Json& inner : part["parts"]) parts.push_back(inner);
  }
  return parts;
}

// null if there is none.
inline Json part_of(const Json& page, const std::string& heading) {
  for (const Json& part : parts_of(page)) {
    if (part.value("heading", "") == heading) return part;
  }
  return nullptr;
}

// The layers of a kind in a figure's first plot, optionally with a name.
inline std::vector<Json> layers_of(const Json& figure, const std::string& kind,
                                   const std::optional<std::string>& name = std::nullopt) {
  std::vector<Json> layers;
  for (const Json& layer : figure["plots"].at(0)["layers"]) {
    if (layer["kind"] == kind && (!name || layer.value("name", "") == *name)) {
      layers.push_back(layer);
    }
  }
  return layers;
}

// A value, or the column of the page with that name.
inline Json column_of(const Json& page, const Json& reference) {
  return reference.is_string() ? page["columns"].at(reference.get<std::string>()) : reference;
}

}  // namespace milepost::testing
