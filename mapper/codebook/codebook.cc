#include "mapper/codebook/codebook.h"

#include <nlohmann/json.hpp>

#include "mapper/codebook/shipped_codebook.h"
#include "schema/base/file.h"

namespace milepost {
namespace {

Result<PcaProjection> codebook_from(const std::string& text, const std::string& where) {
  Result<PcaProjection> codebook =
      PcaProjection::from_json(nlohmann::json::parse(text, nullptr, false));
  if (codebook) return codebook;
  return Error{ErrorCode::corrupt, where, codebook.error().what,
               "make one with milepost-mapper codebook"};
}

}  // namespace

const PcaProjection& shipped_codebook() {
  static const PcaProjection codebook =
      codebook_from(kShippedCodebook, "the shipped codebook").value();
  return codebook;
}

Result<PcaProjection> read_codebook(const std::filesystem::path& file) {
  const Result<std::string> text = read_text_file(file);
  if (!text) return text.error();
  return codebook_from(*text, file.string());
}

std::string codebook_text(const PcaProjection& codebook) {
  return codebook.to_json().dump(1) + "\n";
}

}  // namespace milepost
