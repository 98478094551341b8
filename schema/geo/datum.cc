#include "schema/geo/datum.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "schema/base/digits.h"
#include "schema/base/number.h"

namespace milepost {
namespace {

bool is_name(std::string_view name) {
  constexpr std::size_t kMaxLength = 64;
  constexpr std::string_view kOthers = " ()-_./:+";
  return !name.empty() && name.size() <= kMaxLength && std::ranges::all_of(name, [kOthers](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           kOthers.find(c) != std::string_view::npos;
  });
}

}  // namespace

std::string Datum::text() const { return epoch ? name + "@" + shortest(*epoch) : name; }

Result<Datum> Datum::from(std::string_view text) {
  const std::size_t at = text.find('@');
  Datum datum{std::string(text.substr(0, at)), {}};
  const Error wrong{ErrorCode::invalid_input, "",
                    "is '" + std::string(text.substr(0, 80)) + "', no datum",
                    "write the frame, with its epoch if it has one: ETRF2000 or ITRF2014@2020.5"};
  if (!is_name(datum.name)) return wrong;
  if (at == std::string_view::npos) return datum;
  datum.epoch = finite_number(std::string(text.substr(at + 1)));
  if (!datum.epoch || *datum.epoch < 1980 || *datum.epoch > 2100) return wrong;
  return datum;
}

bool agree(const Datum& a, const Datum& b) {
  constexpr double kMaxYears = 0.5;
  if (!a.is_stated() || !b.is_stated()) return true;
  if (a.name != b.name) return false;
  return !a.epoch || !b.epoch || std::abs(*a.epoch - *b.epoch) <= kMaxYears;
}

Status check_agree(const Datum& datum, const std::string& where, const Datum& other,
                   const std::string& whose) {
  if (agree(datum, other)) return ok_status();
  return Error{ErrorCode::invalid_input, where,
               "its positions are of " + datum.text() + ", those of " + whose + " of " +
                   other.text() + ": they may differ by decimetres",
               "import it with --to-datum " + other.text()};
}

}  // namespace milepost
