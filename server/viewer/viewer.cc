#include "server/viewer/viewer.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "schema/base/digest.h"
#include "server/viewer/viewer_files.h"

namespace milepost::server {
namespace {

constexpr const char* kPageFile = "index.html";

// Text as the value of an attribute.
std::string escaped_html(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

void replace_all(std::string& text, std::string_view from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

Error wrong_tiles(const std::string& url, const std::string& what) {
  return {ErrorCode::invalid_input, "the viewer's tiles '" + url + "'", what,
          "write a URL such as https://tiles.example.org/{z}/{x}/{y}.png"};
}

bool is_host_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
         std::string_view("-.:[]").find(c) != std::string_view::npos;
}

// "https://tiles.example.org" of the URL; nothing of it can end the policy's directive.
Result<std::string> origin_of(const std::string& url) {
  const bool is_http = url.starts_with("http://") || url.starts_with("https://");
  if (!is_http) return wrong_tiles(url, "do not start with https:// or http://");
  const std::size_t host = url.find("://") + 3;
  const std::size_t end = std::min(url.find('/', host), url.size());
  if (end == host ||
      !std::all_of(url.begin() + static_cast<std::ptrdiff_t>(host),
                   url.begin() + static_cast<std::ptrdiff_t>(end), is_host_character)) {
    return wrong_tiles(url, "name no host");
  }
  for (const char* placeholder : {"{z}", "{x}", "{y}"}) {
    if (url.find(placeholder, end) == std::string::npos) {
      return wrong_tiles(url, std::string("lack the placeholder ") + placeholder);
    }
  }
  return url.substr(0, end);
}

std::string policy_for(const std::string& tiles_origin) {
  const std::string tiles = tiles_origin.empty() ? "" : ' ' + tiles_origin;
  return "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:" + tiles +
         "; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
}

}  // namespace

Result<Viewer> Viewer::with(const ViewerSettings& settings) {
  if (settings.tiles_url.empty()) return Viewer(settings, "");
  const Result<std::string> origin = origin_of(settings.tiles_url);
  if (!origin) return origin.error();
  return Viewer(settings, *origin);
}

const Viewer& Viewer::plain() {
  static const Viewer viewer({}, "");
  return viewer;
}

Viewer::Viewer(const ViewerSettings& settings, const std::string& tiles_origin)
    : policy_(policy_for(tiles_origin)) {
  std::string page;
  std::string digests;
  for (const ViewerFile& file : viewer_files()) {
    digests += digest_of(as_bytes(file.text));
    if (file.name == kPageFile) {
      page = file.text;
    } else {
      files_.emplace(file.name, document_of(std::string(file.text)));
    }
  }
  release_ = digest_of(as_bytes(digests));
  replace_all(page, "@RELEASE@", release_);
  replace_all(page, "@TILES_URL@", escaped_html(settings.tiles_url));
  replace_all(page, "@TILES_ATTRIBUTION@", escaped_html(settings.tiles_attribution));
  page_ = document_of(std::move(page));
}

const Document* Viewer::file(const std::string& name) const {
  const auto found = files_.find(name);
  return found == files_.end() ? nullptr : &found->second;
}

}  // namespace milepost::server
