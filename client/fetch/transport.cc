#include "client/fetch/transport.h"

#include <curl/curl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "schema/base/json.h"
#include "schema/command/version.h"

namespace milepost {
namespace {

constexpr std::size_t kMaxProblemBytes = 16UL * 1024;
constexpr long kMaxRedirects = 5;

struct HandleCloser {
  void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
};
using Handle = std::unique_ptr<CURL, HandleCloser>;

void initialize_curl_once() {
  static const CURLcode initialized = curl_global_init(CURL_GLOBAL_DEFAULT);
  static_cast<void>(initialized);
}

// Handles at rest, each with its open connections.
class HandlePool {
 public:
  Handle take() {
    const std::lock_guard lock(mutex_);
    if (resting_.empty()) return Handle(curl_easy_init());
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

// What libcurl's callback needs and fills while an answer arrives.
struct Reception {
  CURL* handle = nullptr;
  const BodySink* sink = nullptr;
  std::uint64_t limit_bytes = 0;
  std::uint64_t received_bytes = 0;
  std::string problem;           // the start of the body of an answer other than 200
  std::optional<Error> refused;  // why we ended the request ourselves
};

long http_status(CURL* handle) {
  long status = 0;
  curl_easy_getinfo(handle, CURLINFO_RESPONSE_CODE, &status);
  return status;
}

bool take_body(Reception& reception, ByteView piece) {
  reception.received_bytes += piece.size();
  if (http_status(reception.handle) != 200) {
    const std::size_t room = kMaxProblemBytes - reception.problem.size();
    reception.problem += as_text(piece.first(std::min(room, piece.size())));
    return piece.size() <= room;  // more than that says no more than its status
  }
  if (reception.received_bytes > reception.limit_bytes) {
    reception.refused = Error{ErrorCode::corrupt, "",
                              "the answer is longer than the " +
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

// The "detail" of a problem+json body; empty if there is none.
std::string detail_of(const std::string& body) {
  const Result<nlohmann::json> json = read_json(body);
  if (!json || !json->is_object()) return "";
  const auto detail = json->find("detail");
  if (detail == json->end() || !detail->is_string()) return "";
  std::string text = detail->get<std::string>();
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return text;
}

Error error_of_status(const std::string& url, long status, const std::string& body) {
  const std::string detail = detail_of(body);
  const auto error = [&](ErrorCode code, const std::string& what, const std::string& mend) {
    return Error{code, url, detail.empty() ? what : what + ": " + detail, mend};
  };
  if (status == 404) return error(ErrorCode::not_found, "the server does not have it", "");
  if (status == 410) {
    return error(ErrorCode::gone, "the map was rebuilt and this build of it is gone",
                 "ask for the map's current build");
  }
  if (status == 400) return error(ErrorCode::invalid_input, "the server calls it wrong", "");
  const std::string number = "HTTP status " + std::to_string(status);
  if (status == 429 || status >= 500) {
    return error(ErrorCode::unavailable, "the server is busy or ill, " + number, "try again later");
  }
  return error(ErrorCode::invalid_input, "the server does not answer it, " + number,
               "check that the URL is a milepost server's");
}

Error error_of_curl(const std::string& url, CURLcode code, const char* message) {
  const std::string what = message[0] != '\0' ? message : curl_easy_strerror(code);
  switch (code) {
    case CURLE_URL_MALFORMAT:
    case CURLE_UNSUPPORTED_PROTOCOL:  // also: an answer that is not HTTP
    case CURLE_TOO_MANY_REDIRECTS:
      return {ErrorCode::invalid_input, url, what, "check that the URL is a milepost server's"};
    case CURLE_WEIRD_SERVER_REPLY:
    case CURLE_WRITE_ERROR:
      return {ErrorCode::corrupt, url, what, "check that the URL is a milepost server's"};
    default:
      return {ErrorCode::unavailable, url, what, "check that the server runs and can be reached"};
  }
}

class CurlTransport : public Transport {
 public:
  explicit CurlTransport(const TransportSettings& settings) : settings_(settings) {
    initialize_curl_once();
  }

  HttpAnswer get(const std::string& url, std::uint64_t body_limit_bytes,
                 const BodySink& sink) override {
    Handle handle = pool_.take();
    if (handle == nullptr) {
      return {Error{ErrorCode::io, url, "libcurl cannot be started", "free some memory"}};
    }
    HttpAnswer answer = perform(handle.get(), url, body_limit_bytes, sink);
    pool_.give_back(std::move(handle));
    return answer;
  }

 private:
  HttpAnswer perform(CURL* handle, const std::string& url, std::uint64_t body_limit_bytes,
                     const BodySink& sink) const {
    Reception reception;
    reception.handle = handle;
    reception.sink = &sink;
    reception.limit_bytes = body_limit_bytes;
    std::array<char, CURL_ERROR_SIZE> message{};
    set_options(handle, url, reception, message.data());
    const CURLcode code = curl_easy_perform(handle);
    HttpAnswer answer;
    answer.body_bytes = reception.received_bytes;
    answer.retry_after_s = retry_after_s(handle);
    answer.status = status_of(handle, url, reception, code, message.data());
    curl_easy_reset(handle);  // forgets pointers into this call; connections stay open
    return answer;
  }

  static Status status_of(CURL* handle, const std::string& url, const Reception& reception,
                          CURLcode code, const char* message) {
    if (reception.refused.has_value()) {
      Error error = *reception.refused;
      if (error.where.empty()) error.where = url;
      return error;
    }
    const bool other_status = http_status(handle) != 200;
    if (other_status && (code == CURLE_OK || code == CURLE_WRITE_ERROR)) {
      return error_of_status(url, http_status(handle), reception.problem);
    }
    if (code == CURLE_OK) return ok_status();
    return error_of_curl(url, code, message);
  }

  void set_options(CURL* handle, const std::string& url, Reception& reception,
                   char* message) const {
    const std::string user_agent = std::string("milepost/") + kVersion;
    curl_easy_setopt(handle, CURLOPT_URL, url.c_str());
    curl_easy_setopt(handle, CURLOPT_NOSIGNAL, 1L);  // timeouts without signals: threads
    curl_easy_setopt(handle, CURLOPT_USERAGENT, user_agent.c_str());  // copied
    curl_easy_setopt(handle, CURLOPT_ERRORBUFFER, message);
    curl_easy_setopt(handle, CURLOPT_PROTOCOLS_STR, "http,https");  // redirects too
    curl_easy_setopt(handle, CURLOPT_FOLLOWLOCATION, 1L);
    curl_easy_setopt(handle, CURLOPT_MAXREDIRS, kMaxRedirects);
    const double connect_ms = std::max(1.0, std::ceil(settings_.connect_timeout_s * 1000));
    curl_easy_setopt(handle, CURLOPT_CONNECTTIMEOUT_MS, static_cast<long>(connect_ms));
    // Less than one byte a second for so long is a stall.
    const double stall_s = std::max(1.0, std::ceil(settings_.stall_timeout_s));
    curl_easy_setopt(handle, CURLOPT_LOW_SPEED_LIMIT, 1L);
    curl_easy_setopt(handle, CURLOPT_LOW_SPEED_TIME, static_cast<long>(stall_s));
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

struct UrlCloser {
  void operator()(CURLU* url) const { curl_url_cleanup(url); }
};

std::string url_part(CURLU* url, CURLUPart part) {
  char* text = nullptr;
  if (curl_url_get(url, part, &text, 0) != CURLUE_OK) return "";
  std::string copy(text);
  curl_free(text);
  return copy;
}

}  // namespace

std::unique_ptr<Transport> make_curl_transport(const TransportSettings& settings) {
  return std::make_unique<CurlTransport>(settings);
}

Result<std::string> checked_server_url(const std::string& base) {
  const std::unique_ptr<CURLU, UrlCloser> url(curl_url());
  const bool parsed = curl_url_set(url.get(), CURLUPART_URL, base.c_str(), 0) == CURLUE_OK;
  const std::string scheme = parsed ? url_part(url.get(), CURLUPART_SCHEME) : "";
  const bool plain = parsed && url_part(url.get(), CURLUPART_QUERY).empty() &&
                     url_part(url.get(), CURLUPART_FRAGMENT).empty();
  if (!plain || (scheme != "http" && scheme != "https")) {
    return Error{ErrorCode::invalid_input, base, "this is not a server's URL",
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
