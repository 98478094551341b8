#include "server/catalog/build_changes.h"

#include <algorithm>
#include <cstdint>

#include <nlohmann/json.hpp>

namespace milepost::server {
namespace {

using Json = nlohmann::ordered_json;

// The entries of a layer by two builds.
template <class Entry>
struct LayerChange {
  Json changed = Json::array();  // or new
  Json removed = Json::array();

  bool any() const { return !changed.empty() || !removed.empty(); }
};

class Changes {
 public:
  Changes(const ServedMap& from, const ServedMap& to) : from_(from), to_(to) {}

  Json document() {
    Json json = {{"map", to_.name()}, {"from", from_.build()}, {"to", to_.build()}};
    if (from_.summary().digest != to_.summary().digest) json["document"] = listed(to_.summary());
    json["segments"] = segments();
    if (from_.areas().digest != to_.areas().digest) {
      Json areas = listed(to_.areas());
      areas["cells"] = layers(from_.cells(), to_.cells(), "cell", &CellEntry::cell);
      json["areas"] = std::move(areas);
    }
    json["bytes"] = bytes_;  // of all that is listed as changed or new
    return json;
  }

 private:
  Json listed(const Document& document) {
    bytes_ += document.text->size();
    return {{"bytes", document.text->size()}, {"digest", document.digest}};
  }

  Json segments() {
    Json list = Json::array();
    for (const auto& [id, segment] : to_.segments()) {
      const auto before = from_.segments().find(id);
      const bool is_new = before == from_.segments().end();
      if (!is_new && before->second.document.digest == segment.document.digest) continue;
      Json json = {{"segment", id}, {"change", is_new ? "added" : "changed"}};
      json.update(listed(segment.document));
      static const std::map<std::string, std::vector<TileEntry>> kNone;
      json["tiles"] =
          layers(is_new ? kNone : before->second.tiles, segment.tiles, "index", &TileEntry::index);
      list.push_back(std::move(json));
    }
    for (const auto& [id, segment] : from_.segments()) {
      if (!to_.segments().contains(id)) list.push_back({{"segment", id}, {"change", "removed"}});
    }
    return list;
  }

  template <class Entry>
  Json layers(const std::map<std::string, std::vector<Entry>>& from,
              const std::map<std::string, std::vector<Entry>>& to, const char* number,
              std::uint32_t Entry::*number_of) {
    static const std::vector<Entry> kNone;
    Json json = Json::object();
    for (const auto& [layer, entries] : to) {
      const auto before = from.find(layer);
      const auto change =
          layer_change(before == from.end() ? kNone : before->second, entries, number, number_of);
      if (change.any()) json[layer] = {{"changed", change.changed}, {"removed", change.removed}};
    }
    for (const auto& [layer, entries] : from) {
      if (to.contains(layer) || entries.empty()) continue;
      const auto change = layer_change(entries, kNone, number, number_of);
      json[layer] = {{"changed", change.changed}, {"removed", change.removed}};
    }
    return json;
  }

  // Both ascend by their numbers.
  template <class Entry>
  LayerChange<Entry> layer_change(const std::vector<Entry>& from, const std::vector<Entry>& to,
                                  const char* number, std::uint32_t Entry::*number_of) {
    LayerChange<Entry> change;
    auto old = from.begin();
    const auto remove_below = [&](std::uint64_t limit) {
      for (; old != from.end() && (*old).*number_of < limit; ++old)
        change.removed.push_back((*old).*number_of);
    };
    for (const Entry& entry : to) {
      remove_below(entry.*number_of);
      const bool is_there = old != from.end() && (*old).*number_of == entry.*number_of;
      const bool is_same = is_there && old->digest == entry.digest;
      if (is_there) ++old;
      if (is_same) continue;
      change.changed.push_back(
          {{number, entry.*number_of}, {"bytes", entry.bytes}, {"digest", entry.digest}});
      bytes_ += entry.bytes;
    }
    remove_below(std::uint64_t{1} << 32);
    return change;
  }

  const ServedMap& from_;
  const ServedMap& to_;
  std::uint64_t bytes_ = 0;
};

}  // namespace

std::string changes_document(const ServedMap& from, const ServedMap& to) {
  return Changes(from, to).document().dump();
}

}  // namespace milepost::server
