// Finding one's way in a report's data.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/evaluate/report/report_json.h"

namespace milepost::testing {

// The parts, with those of groups.
inline std::vector<Json> parts_of(const Json& page) {
  std::vector<Json> parts;
  for (const Json& part : page["parts"]) {
    parts.push_back(part);
    if (!part.contains("parts")) continue;
    for (const Json& inner : part["parts"]) parts.push_back(inner);
  }
  return parts;
}

// null where there is none.
inline Json part_of(const Json& page, const std::string& heading) {
  for (const Json& part : parts_of(page)) {
    if (part.value("heading", "") == heading) return part;
  }
  return nullptr;
}

// Of a figure's first plot, the layers of a kind, and of a name where one is given.
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

// A value, or what the page's columns hold under its name.
inline Json column_of(const Json& page, const Json& reference) {
  return reference.is_string() ? page["columns"].at(reference.get<std::string>()) : reference;
}

}  // namespace milepost::testing
