// RAII for GDAL: datasets that close themselves, and suppression of its messages.
#pragma once

#include <gdal_priv.h>

#include <algorithm>
#include <memory>
#include <string>

namespace milepost {

using Dataset = std::unique_ptr<GDALDataset, decltype(&GDALClose)>;

// While it exists GDAL prints nothing to standard error; its last message is kept.
class QuietGdal {
 public:
  QuietGdal() {
    CPLPushErrorHandler(CPLQuietErrorHandler);
    CPLErrorReset();
  }
  ~QuietGdal() { CPLPopErrorHandler(); }
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;

  // " (MESSAGE)", or empty if there was none.
  static std::string in_brackets() {
    std::string text = CPLGetLastErrorMsg();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.empty() ? text : " (" + text + ")";
  }
};

}  // namespace milepost
