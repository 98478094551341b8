#include "server/hot/hot_answers.h"

#include <functional>

namespace milepost::server {

HotAnswers::HotAnswers(std::size_t bytes) {
  for (auto& shard : shards_) shard = std::make_unique<Shard>(bytes / shards_.size());
}

PreparedAnswer HotAnswers::find(std::string_view target,
                                const std::shared_ptr<const Catalog>& catalog) {
  Shard& shard = shard_of(target);
  {
    const std::lock_guard lock(shard.mutex);
    if (shard.catalog == catalog) return shard.answers.find(target);
  }
  keep_only(catalog);
  return nullptr;
}

void HotAnswers::add(std::string_view target, const std::shared_ptr<const Catalog>& catalog,
                     const PreparedAnswer& answer) {
  if (!answer->unchanged) return;
  Shard& shard = shard_of(target);
  const std::lock_guard lock(shard.mutex);
  // The catalog may have been replaced since the answer was looked for.
  if (shard.catalog == catalog) shard.answers.add(target, answer, answer->bytes());
}

// Answers of another catalog keep its documents, so that they leave all shards at once.
void HotAnswers::keep_only(const std::shared_ptr<const Catalog>& catalog) {
  for (const auto& shard : shards_) {
    const std::lock_guard lock(shard->mutex);
    if (shard->catalog == catalog) continue;
    shard->answers.clear();
    shard->catalog = catalog;
  }
}

HotAnswers::Shard& HotAnswers::shard_of(std::string_view target) {
  return *shards_[std::hash<std::string_view>()(target) % shards_.size()];
}

}  // namespace milepost::server
