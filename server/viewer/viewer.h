// The viewer: a page that shows the catalog on a map, and the files that it loads.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "schema/base/result.h"
#include "server/catalog/document.h"

namespace milepost::server {

struct ViewerSettings {
  // An operator's layer of map tiles beneath the network, in Web Mercator, such as
  // "https://tiles.example.org/{z}/{x}/{y}.png"; empty: a plain ground.
  std::string tiles_url;
  std::string tiles_attribution;  // plain text, shown on the map
};

// Immutable, so safe to share between threads.
class Viewer {
 public:
  // Errors: invalid_input (the URL of the tiles is none, or lacks a placeholder).
  static Result<Viewer> with(const ViewerSettings& settings);
  // With a plain ground.
  static const Viewer& plain();

  // Of the page: HTML, and its Content-Security-Policy, which allows this server and the host of
  // the tiles.
  const Document& page() const { return page_; }
  const std::string& policy() const { return policy_; }

  // Digest of all files. It is in their URLs, so that a page loads the files of its own release.
  const std::string& release() const { return release_; }
  // A file by its name; null if there is none.
  const Document* file(const std::string& name) const;

 private:
  explicit Viewer(const ViewerSettings& settings, const std::string& tiles_origin);

  std::map<std::string, Document> files_;
  std::string release_;
  Document page_;
  std::string policy_;
};

}  // namespace milepost::server
