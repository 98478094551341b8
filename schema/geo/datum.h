// The reference frame of positions, and the time that they are of.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "schema/base/result.h"

namespace milepost {

// Continents drift: positions of one place in two frames, or in one of the Earth's frames (ITRF) at
// times years apart, differ by decimetres (in Europe ETRS89 and ITRF by 0.8 m).
struct Datum {
  std::string name;             // "ITRF2014", "ETRF2000", "WGS 84"; empty: not stated
  std::optional<double> epoch;  // decimal year, 1980 to 2100

  bool is_stated() const { return !name.empty(); }
  // "ITRF2014@2020.5"; empty if it is not stated.
  std::string text() const;

  // Errors: invalid_input, with `where` empty.
  static Result<Datum> from(std::string_view text);
};

// Whether positions of both can be used together: one frame, and epochs at most half a year apart
// where both are stated. One that is not stated may be the other.
bool agree(const Datum& a, const Datum& b);

// "its positions are of A, those of WHOSE of B". Errors: invalid_input, if they do not agree.
Status check_agree(const Datum& datum, const std::string& where, const Datum& other,
                   const std::string& whose);

}  // namespace milepost
