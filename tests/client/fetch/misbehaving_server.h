// A server with the fake map that can misbehave, and sources that do not wait.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "client/fetch/http_source_parts.h"
#include "tests/client/fetch/fake_map.h"
#include "tests/support/scripted_server.h"
#include "tests/support/temp_folder.h"

namespace milepost::testing {

class MisbehavingServerTest : public ::testing::Test {
 protected:
  using IsTarget = bool (*)(const std::string& target);

  std::shared_ptr<MapSource> open_source() { return open_source(server_.url()); }

  std::shared_ptr<MapSource> open_source(const std::string& url) {
    HttpSourceSettings settings;
    settings.server_url = url;
    settings.cache_directory = cache_.path();
    settings.cache_limit_bytes = cache_limit_bytes_;
    settings.keys = keys_;
    HttpSourceParts parts;
    parts.transport = make_curl_transport({5, 10});
    parts.sleep = [this](double pause_s, const Stopped&) { pauses_s_.push_back(pause_s); };
    parts.steady_s = [this] { return now_s_.load(); };
    auto source = make_http_source(settings, std::move(parts));
    EXPECT_TRUE(source.ok());
    return std::move(source).value();
  }

  // Gives these responses to the next requests whose target `matches`, before the map answers
  // again.
  void answer_next(const std::string& matches, std::vector<ScriptedAnswer> answers) {
    const std::lock_guard lock(mutex_);
    special_target_ = matches;
    special_answers_ = std::move(answers);
  }

  // Gives this response to everything, except "/loop" (a redirect to itself) and "/login" (a page);
  // none: the map answers again.
  void answer_all(std::optional<ScriptedAnswer> answer) {
    const std::lock_guard lock(mutex_);
    answer_to_all_ = std::move(answer);
  }

  // Modifies every response to requests of that kind.
  void spoil_answers(IsTarget kind, std::function<void(std::string& body)> spoil) {
    const std::lock_guard lock(mutex_);
    spoilt_kind_ = kind;
    spoil_ = std::move(spoil);
  }

  // The requested targets of that kind.
  std::vector<std::string> requests(IsTarget kind) const {
    std::vector<std::string> targets = server_.requests();
    std::erase_if(targets, [kind](const std::string& target) { return !kind(target); });
    return targets;
  }

  FakeMap map_;
  TempFolder cache_;
  std::uint64_t cache_limit_bytes_ = 1ULL << 30U;
  std::vector<PublicKey> keys_;  // of the sources opened next
  std::atomic<std::int64_t> now_s_ = 1000;
  std::vector<double> pauses_s_;

 private:
  ScriptedAnswer answer(const std::string& target) {
    const std::lock_guard lock(mutex_);
    if (target == "/loop") return {.status = 302, .headers = {{"Location", "/loop"}}};
    if (target == "/login") return {.body = "<html>", .headers = {{"Content-Type", "text/html"}}};
    if (answer_to_all_) return *answer_to_all_;
    const bool special =
        !special_answers_.empty() && target.find(special_target_) != std::string::npos;
    if (special) {
      ScriptedAnswer next = special_answers_.front();
      special_answers_.erase(special_answers_.begin());
      return next;
    }
    ScriptedAnswer usual = map_.answer(target);
    if (spoil_ && spoilt_kind_(target)) spoil_(usual.body);
    return usual;
  }

  std::mutex mutex_;
  std::optional<ScriptedAnswer> answer_to_all_;
  std::string special_target_;
  std::vector<ScriptedAnswer> special_answers_;
  IsTarget spoilt_kind_ = nullptr;
  std::function<void(std::string&)> spoil_;

 protected:
  ScriptedServer server_{[this](const std::string& target) { return answer(target); }};
};

}  // namespace milepost::testing
