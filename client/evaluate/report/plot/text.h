// Text for HTML and SVG: escaping, and numbers that look the same in every locale.
#pragma once

#include <string>
#include <string_view>

namespace milepost::plot {

// `text` as the content of an element or of a quoted attribute: the five markup characters become
// references; bytes that are no UTF-8 and characters that XML forbids become U+FFFD.
std::string escaped(std::string_view text);

// For readers: "0.25", with a true minus sign; an en dash for what is not finite.
std::string number(double value, int decimals);
// The same with a plus sign before what rounds to more than zero.
std::string signed_number(double value, int decimals);

// For attributes: "-0.25". REQUIRES: value is finite.
std::string coordinate(double value, int decimals);

// For attributes: a share as a percentage with two decimals, "33.12%". REQUIRES: share is finite.
std::string percent(double share);

}  // namespace milepost::plot
