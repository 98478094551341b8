// A real HTTP server on loopback that answers as a test tells it to, badly too.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace milepost::testing {

struct ScriptedAnswer {
  int status = 200;
  std::string body = {};
  std::map<std::string, std::string> headers = {};
  std::optional<std::size_t> break_off_after = {};  // bytes of the body, then the end
  bool silent = false;                              // never answers; the connection stays open
};

// One thread of its own; the handler runs in it, one request at a time.
class ScriptedServer {
 public:
  using Handler = std::function<ScriptedAnswer(const std::string& target)>;

  explicit ScriptedServer(Handler handler);
  ~ScriptedServer();
  ScriptedServer(const ScriptedServer&) = delete;
  ScriptedServer& operator=(const ScriptedServer&) = delete;

  // http://127.0.0.1:PORT
  std::string url() const;
  // The targets asked for so far, in order.
  std::vector<std::string> requests() const;
  // The User-Agent of the last request.
  std::string user_agent() const;
  // The Cache-Control of the last request, which is being answered within the handler.
  std::string cache_control() const;
  std::size_t connections() const;
  // Refuses connections from now on and closes those that are open.
  void stop();

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost::testing
