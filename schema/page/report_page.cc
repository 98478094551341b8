#include "schema/page/report_page.h"

#include <sodium.h>

#include <array>
#include <string_view>
#include <utility>

#include "schema/page/report_page_files.h"

namespace milepost {
namespace {

bool begins_report(std::string_view head) {
  return head.starts_with("<!DOCTYPE html>") &&
         head.find(" \u2013 milepost ") != std::string_view::npos;
}

// The source expression of a script in a content security policy.
std::string script_hash(std::string_view script) {
  std::array<unsigned char, crypto_hash_sha256_BYTES> hash{};
  crypto_hash_sha256(hash.data(), reinterpret_cast<const unsigned char*>(script.data()),
                     script.size());
  std::array<char,
             sodium_base64_ENCODED_LEN(crypto_hash_sha256_BYTES, sodium_base64_VARIANT_ORIGINAL)>
      text{};
  sodium_bin2base64(text.data(), text.size(), hash.data(), hash.size(),
                    sodium_base64_VARIANT_ORIGINAL);
  return "'sha256-" + std::string(text.data()) + "'";
}

std::string json_text(const Json& data) {
  const std::string json = data.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string text;
  text.reserve(json.size());
  for (const char each : json) {
    if (each == '<') {
      text += "\\u003c";
    } else {
      text += each;
    }
  }
  return text;
}

}  // namespace

const OutputKind kReportOutput = {"a report of milepost", begins_report, true};

std::string report_page(const Json& data) {
  const ReportPageFiles files = report_page_files();
  const std::array<std::pair<std::string_view, std::string>, 6> parts = {{
      {"@SCRIPT_HASHES@", script_hash(files.library) + " " + script_hash(files.script)},
      {"@STYLE@", std::string(files.style)},
      {"@DATA@", json_text(data)},
      {"@LICENCE@", std::string(files.licence)},
      {"@LIBRARY@", std::string(files.library)},
      {"@SCRIPT@", std::string(files.script)},
  }};
  // The template contains each placeholder once, in this order; inserted text is not searched
  // again.
  std::string page;
  std::string_view rest = files.page;
  for (const auto& [name, text] : parts) {
    const std::size_t at = rest.find(name);
    page.append(rest.substr(0, at)).append(text);
    rest.remove_prefix(at + name.size());
  }
  return page.append(rest);
}

}  // namespace milepost
