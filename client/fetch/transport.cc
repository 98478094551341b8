#include "client/fetch/transport.h"

#include <curl/curl.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "schema/base/json.h"
#include "schema/command/version.h"

namespace milepost {
namespace {

constexpr std::size_t kMaxRefusalBytes = 16UL * 1024;
constexpr long kMaxRedirects = 5;
constexpr std::size_t kMaxTypeBytes = 60;

struct EasyCloser {
  void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
};
struct MultiCloser {
  void operator()(CURLM* handle) const { curl_multi_cleanup(handle); }
};

struct HeadersCloser {
  void operator()(curl_slist* headers) const { curl_slist_free_all(headers); }
};
using Headers = std::unique_ptr<curl_slist, HeadersCloser>;

// A libcurl handle for consecutive requests. The connections belong to `multi`, which must outlive
// `easy`.
struct Handle {
  std::unique_ptr<CURLM, MultiCloser> multi;
  std::unique_ptr<CURL, EasyCloser> easy;

  static Handle make() {
    return {std::unique_ptr<CURLM, MultiCloser>(curl_multi_init()),
            std::unique_ptr<CURL, EasyCloser>(curl_easy_init())};
  }
  explicit operator bool() const { return multi && easy; }
};

void initialize_curl_once() {
  static const CURLcode initialized = curl_global_init(CURL_GLOBAL_DEFAULT);
  static_cast<void>(initialized);
}

// Idle handles, each with its open connections.
class HandlePool {
 public:
  Handle take() {
    const std::lock_guard lock(mutex_);
    if (resting_.empty()) return Handle::make();
    Handle handle = std::move(resting_.back());
    resting_.pop_back();
    return handle;
  }

  void give_back(Handle handle) {
    const std::lock_guard lock(mutex_);
    resting_.push_back(std::move(handle));
  }

 private:
  std::mutex mutex_;
  std::vector<Handle> resting_;
};

// The state of libcurl's callback while a response arrives.
struct Reception {
  CURL* handle = nullptr;
  const BodySink* sink = nullptr;
  std::uint64_t limit_bytes = 0;
  std::uint64_t received_bytes = 0;
  std::string refusal;           // the start of a body that is not passed to the sink
  std::optional<Error> refused;  // why the callback aborted the request
};

long http_status(CURL* handle) {
  long status = 0;
  curl_easy_getinfo(handle, CURLINFO_RESPONSE_CODE, &status);
  return status;
}

// The media type of the response in lower case, without parameters; empty if it has none.
std::string media_type(CURL* handle) {
  const char* header = nullptr;
  curl_easy_getinfo(handle, CURLINFO_CONTENT_TYPE, &header);
  std::string type(header == nullptr ? "" : header);
  type.resize(std::min({type.size(), type.find_first_of("; "), kMaxTypeBytes}));
  for (char& c : type) {
    const bool plain = c > 0x20 && c < 0x7f;
    c = plain ? static_cast<char>(std::tolower(c)) : '?';
  }
  return type;
}

// Whether the response header announces the requested document or tiles. An HTML page never counts,
// whatever its status.
bool is_for_the_sink(CURL* handle) {
  const std::string type = media_type(handle);
  return http_status(handle) == 200 && type != "text/html" && type != "application/xhtml+xml";
}

bool take_body(Reception& reception, ByteView piece) {
  reception.received_bytes += piece.size();
  if (!is_for_the_sink(reception.handle)) {
    const std::size_t room = kMaxRefusalBytes - reception.refusal.size();
    reception.refusal += as_text(piece.first(std::min(room, piece.size())));
    return piece.size() <= room;  // the rest of a longer body adds nothing to the status
  }
  if (reception.received_bytes > reception.limit_bytes) {
    reception.refused = Error{ErrorCode::corrupt, "",
                              "the response is longer than the " +
                                  std::to_string(reception.limit_bytes) + " bytes expected",
                              "check that the URL is a milepost server's"};
    return false;
  }
  Status taken = (*reception.sink)(piece);
  if (!taken.ok()) reception.refused = taken.error();
  return taken.ok();
}

std::size_t on_body(char* data, std::size_t /*always_one*/, std::size_t size, void* user) {
  const bool taken = take_body(*static_cast<Reception*>(user), as_bytes({data, size}));
  return taken ? size : CURL_WRITEFUNC_ERROR;
}

// ": DETAIL" of a problem document; empty if it has none.
std::string detail_of(const nlohmann::json& problem) {
  const auto detail = problem.find("detail");
  if (detail == problem.end() || !detail->is_string()) return "";
  std::string text = ": " + detail->get<std::string>();
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return text;
}

// The error for a problem document; none if the status only means that something is unavailable, or
// is never sent by a milepost server.
std::optional<Error> error_of_problem(const std::string& url, long status,
                                      const nlohmann::json& problem) {
  const std::string detail = detail_of(problem);
  switch (status) {
    case 404:
      return Error{ErrorCode::not_found, url, "the server does not have it" + detail, ""};
    case 410:
      return Error{ErrorCode::gone, url,
                   "the map was rebuilt and this build of it is gone" + detail,
                   "ask for the map's current build"};
    case 400:
      return Error{ErrorCode::invalid_input, url, "the server rejects the request" + detail, ""};
    case 401:
    case 403:  // the operator may yet allow it: what is in the cache is of use until then
      return Error{ErrorCode::unavailable, url, "the server does not allow it" + detail,
                   "give a valid token of the server's operator"};
    case 405:
    case 413:
    case 414:
    case 431:
      return Error{ErrorCode::invalid_input, url,
                   "the server rejects the request, HTTP status " + std::to_string(status) + detail,
                   "check that the URL is a milepost server's"};
    default:
      return std::nullopt;
  }
}

HttpAnswer foreign(const std::string& url, const std::string& what) {
  return {.status = foreign_answer(url, what), .is_foreign = true};
}

// The outcome of a response that was not passed to the sink.
HttpAnswer refused_answer(CURL* handle, const std::string& url, const std::string& body) {
  const long status = http_status(handle);
  const std::string type = media_type(handle);
  const auto problem = read_json(type == "application/problem+json" ? body : "");
  const bool is_problem = problem.ok() && problem->is_object();
  if (is_problem) {
    if (const auto error = error_of_problem(url, status, *problem)) return {*error};
  }
  const std::string number = "HTTP status " + std::to_string(status);
  if (status == 429 || (status >= 500 && status != 511)) {  // 511: the network requires a login
    return {Error{ErrorCode::unavailable, url,
                  "the server is unavailable, " + number + (is_problem ? detail_of(*problem) : ""),
                  "try again later"}};
  }
  return foreign(url, type.empty() ? number : number + ", " + type);
}

struct UrlCloser {
  void operator()(CURLU* url) const { curl_url_cleanup(url); }
};
using Url = std::unique_ptr<CURLU, UrlCloser>;

// Null if the text is not a valid URL.
Url parsed_url(const std::string& text) {
  Url url(curl_url());
  if (curl_url_set(url.get(), CURLUPART_URL, text.c_str(), 0) != CURLUE_OK) url.reset();
  return url;
}

std::string url_part(CURLU* url, CURLUPart part) {
  char* text = nullptr;
  if (curl_url_get(url, part, &text, 0) != CURLUE_OK) return "";
  std::string copy(text);
  curl_free(text);
  return copy;
}

bool is_http(CURLU* url) {
  const std::string scheme = url_part(url, CURLUPART_SCHEME);
  return scheme == "http" || scheme == "https";
}

HttpAnswer failed_answer(const std::string& url, CURLcode code, const char* message) {
  const std::string what = message[0] != '\0' ? message : curl_easy_strerror(code);
  switch (code) {
    case CURLE_URL_MALFORMAT:
    case CURLE_UNSUPPORTED_PROTOCOL: {  // also a response that is not HTTP
      const Url asked = parsed_url(url);
      if (asked != nullptr && is_http(asked.get())) return foreign(url, what);
      return {
          Error{ErrorCode::invalid_input, url, what, "check that the URL is a milepost server's"}};
    }
    case CURLE_TOO_MANY_REDIRECTS:
    case CURLE_WEIRD_SERVER_REPLY:
      return foreign(url, what);
    default:
      return {Error{ErrorCode::unavailable, url, what,
                    "check that the server runs and can be reached"}};
  }
}

class CurlTransport : public Transport {
 public:
  explicit CurlTransport(TransportSettings settings) : settings_(std::move(settings)) {
    initialize_curl_once();
  }

  HttpAnswer get(const std::string& url, std::uint64_t body_limit_bytes, Caches caches,
                 const BodySink& sink, const Stopped& stopped) override {
    Handle handle = pool_.take();
    if (!handle) {
      return {Error{ErrorCode::io, url, "libcurl cannot be initialized", "free some memory"}};
    }
    HttpAnswer answer = perform(handle, url, body_limit_bytes, caches, sink, stopped);
    pool_.give_back(std::move(handle));
    return answer;
  }

 private:
  HttpAnswer perform(const Handle& connection, const std::string& url,
                     std::uint64_t body_limit_bytes, Caches caches, const BodySink& sink,
                     const Stopped& stopped) const {
    CURL* const handle = connection.easy.get();
    Reception reception;
    reception.handle = handle;
    reception.sink = &sink;
    reception.limit_bytes = body_limit_bytes;
    std::array<char, CURL_ERROR_SIZE> message{};
    set_options(handle, url, reception, message.data());
    const Headers headers(caches == Caches::bypassed
                              ? curl_slist_append(nullptr, "Cache-Control: no-cache")
                              : nullptr);
    curl_easy_setopt(handle, CURLOPT_HTTPHEADER, headers.get());
    const std::optional<CURLcode> code = run(connection, stopped);
    HttpAnswer answer = code ? answer_of(handle, url, reception, *code, message.data())
                             : HttpAnswer{cancelled(url)};
    answer.body_bytes = reception.received_bytes;
    answer.retry_after_s = retry_after_s(handle);
    curl_easy_reset(handle);  // clears pointers to locals; connections stay open
    return answer;
  }

  // None if it was stopped.
  static std::optional<CURLcode> run(const Handle& connection, const Stopped& stopped) {
    constexpr int kLongestWaitMs = 50;
    CURLM* const multi = connection.multi.get();
    int running = 1;
    CURLMcode driven = curl_multi_add_handle(multi, connection.easy.get());
    while (driven == CURLM_OK && !is_stopped(stopped)) {
      driven = curl_multi_perform(multi, &running);
      if (running == 0) break;
      if (driven == CURLM_OK) {
        driven = curl_multi_poll(multi, nullptr, 0, kLongestWaitMs, nullptr);
      }
    }
    std::optional<CURLcode> code;
    if (driven != CURLM_OK) code = CURLE_FAILED_INIT;
    int left = 0;
    while (const CURLMsg* message = curl_multi_info_read(multi, &left)) {
      if (message->msg == CURLMSG_DONE) code = message->data.result;
    }
    curl_multi_remove_handle(multi, connection.easy.get());
    return code;
  }

  // Without body_bytes and retry_after_s.
  static HttpAnswer answer_of(CURL* handle, const std::string& url, const Reception& reception,
                              CURLcode code, const char* message) {
    if (reception.refused.has_value()) {
      Error error = *reception.refused;
      if (error.where.empty()) error.where = url;
      return {error};
    }
    // CURLE_WRITE_ERROR: the callback aborted a body that is too long for an error response.
    const bool answered = code == CURLE_OK || code == CURLE_WRITE_ERROR;
    if (answered && !is_for_the_sink(handle)) {
      return refused_answer(handle, url, reception.refusal);
    }
    if (code == CURLE_OK) return {};
    return failed_answer(url, code, message);
  }

  void set_options(CURL* handle, const std::string& url, Reception& reception,
                   char* message) const {
    const std::string user_agent = std::string("milepost/") + kVersion;
    curl_easy_setopt(handle, CURLOPT_URL, url.c_str());
    curl_easy_setopt(handle, CURLOPT_NOSIGNAL, 1L);    // no signals for timeouts: several threads
    curl_easy_setopt(handle, CURLOPT_QUICK_EXIT, 1L);  // does not wait for name resolution
    curl_easy_setopt(handle, CURLOPT_USERAGENT, user_agent.c_str());  // copied
    curl_easy_setopt(handle, CURLOPT_ERRORBUFFER, message);
    curl_easy_setopt(handle, CURLOPT_PROTOCOLS_STR, "http,https");  // redirects too
    curl_easy_setopt(handle, CURLOPT_FOLLOWLOCATION, 1L);
    curl_easy_setopt(handle, CURLOPT_MAXREDIRS, kMaxRedirects);
    const double connect_ms = std::max(1.0, std::ceil(settings_.connect_timeout_s * 1000));
    curl_easy_setopt(handle, CURLOPT_CONNECTTIMEOUT_MS, static_cast<long>(connect_ms));
    const double stall_s = std::max(1.0, std::ceil(settings_.stall_timeout_s));
    curl_easy_setopt(handle, CURLOPT_LOW_SPEED_LIMIT,
                     static_cast<long>(std::max(1.0, settings_.least_bytes_per_s)));
    curl_easy_setopt(handle, CURLOPT_LOW_SPEED_TIME, static_cast<long>(stall_s));
    curl_easy_setopt(handle, CURLOPT_ACCEPT_ENCODING, "zstd, gzip");
    if (!settings_.ca_file.empty()) {
      curl_easy_setopt(handle, CURLOPT_CAINFO, settings_.ca_file.c_str());
    }
    if (!settings_.token.empty()) {
      curl_easy_setopt(handle, CURLOPT_HTTPAUTH, CURLAUTH_BEARER);
      curl_easy_setopt(handle, CURLOPT_XOAUTH2_BEARER, settings_.token.c_str());
    }
    curl_easy_setopt(handle, CURLOPT_WRITEFUNCTION, &on_body);
    curl_easy_setopt(handle, CURLOPT_WRITEDATA, &reception);
  }

  static double retry_after_s(CURL* handle) {
    curl_off_t seconds = 0;
    curl_easy_getinfo(handle, CURLINFO_RETRY_AFTER, &seconds);
    return static_cast<double>(seconds);
  }

  const TransportSettings settings_;
  HandlePool pool_;
};

}  // namespace

std::unique_ptr<Transport> make_curl_transport(const TransportSettings& settings) {
  return std::make_unique<CurlTransport>(settings);
}

Error foreign_answer(const std::string& url, const std::string& what) {
  return {ErrorCode::unavailable, url,
          "something other than a milepost server answered, perhaps a login page of the network: " +
              what,
          "log in to the network, or check the server's URL"};
}

Result<std::string> checked_server_url(const std::string& base) {
  const Url url = parsed_url(base);
  const bool plain = url != nullptr && is_http(url.get()) &&
                     url_part(url.get(), CURLUPART_QUERY).empty() &&
                     url_part(url.get(), CURLUPART_FRAGMENT).empty();
  if (!plain) {
    return Error{ErrorCode::invalid_input, base, "this is not a valid server URL",
                 "give it as http://HOST:PORT"};
  }
  return base.substr(0, base.find_last_not_of('/') + 1);
}

std::string escaped_for_url(const std::string& text) {
  const std::unique_ptr<char, decltype(&curl_free)> escaped(
      curl_easy_escape(nullptr, text.data(), static_cast<int>(text.size())), &curl_free);
  return escaped == nullptr ? "" : std::string(escaped.get());
}

}  // namespace milepost
