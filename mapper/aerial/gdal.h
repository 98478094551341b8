// GDAL as the orthoimage needs it: datasets that close themselves, messages that stay off standard
// error.
#pragma once

#include <gdal_priv.h>

#include <algorithm>
#include <memory>
#include <string>

namespace milepost {

using Dataset = std::unique_ptr<GDALDataset, decltype(&GDALClose)>;

// While it lives GDAL says nothing on standard error; its last message is kept.
class QuietGdal {
 public:
  QuietGdal() {
    CPLPushErrorHandler(CPLQuietErrorHandler);
    CPLErrorReset();
  }
  ~QuietGdal() { CPLPopErrorHandler(); }
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;

  // " (MESSAGE)", or nothing where there was none.
  static std::string in_brackets() {
    std::string text = CPLGetLastErrorMsg();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.empty() ? text : " (" + text + ")";
  }
};

}  // namespace milepost
