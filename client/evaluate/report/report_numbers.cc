#include "client/evaluate/report/report_numbers.h"

#include <algorithm>
#include <cmath>

#include "client/evaluate/report/plot/text.h"
#include "client/evaluate/statistics.h"

namespace milepost {
namespace {

constexpr double kHeadroom = 1.05;  // so that the greatest value is not half outside the plot

}  // namespace

double robust_reach(std::vector<double> magnitudes) {
  magnitudes = finite_only(magnitudes);
  if (magnitudes.empty()) return 0;
  for (double& each : magnitudes) each = std::abs(each);
  std::sort(magnitudes.begin(), magnitudes.end());
  const double usual = quantile(magnitudes, 0.9);
  return kHeadroom * (usual > 0 ? std::min(magnitudes.back(), 2.5 * usual) : magnitudes.back());
}

std::string metres(double value) {
  // Decimals follow the number as it is printed: 0.0996 is 0.10.
  return plot::number(value, std::abs(value) < 0.0995 ? 3 : 2) + "\u00A0m";
}

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " and " : ", ";
    text += words[i];
  }
  return text;
}

}  // namespace milepost
