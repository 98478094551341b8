#include "schema/feature/pca_projection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sodium.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <nlohmann/json.hpp>

namespace milepost {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;

constexpr double kStep = 0.01;

// Similar to SIFT's: a few patterns of varying strength, so that few axes hold most variance.
std::vector<Descriptor> random_descriptors(std::size_t count) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<std::array<double, kDescriptorBytes>> patterns(12);
  for (auto& pattern : patterns) {
    for (double& value : pattern) value = normal(random);
  }
  std::vector<Descriptor> descriptors(count);
  for (Descriptor& descriptor : descriptors) {
    std::array<double, kDescriptorBytes> values;
    values.fill(60);
    for (const auto& pattern : patterns) {
      const double strength = 12 * normal(random);
      for (std::size_t d = 0; d < values.size(); ++d) values[d] += strength * pattern[d];
    }
    for (std::size_t d = 0; d < values.size(); ++d) {
      descriptor[d] = static_cast<std::uint8_t>(std::clamp(values[d], 0.0, 255.0));
    }
  }
  return descriptors;
}

std::array<double, kDescriptorBytes> root_sift_of(const Descriptor& descriptor) {
  double sum = 0;
  for (const double value : descriptor) sum += value;
  std::array<double, kDescriptorBytes> root{};
  for (std::size_t d = 0; d < root.size(); ++d) root[d] = std::sqrt(descriptor[d] / sum);
  return root;
}

double root_sift_distance(const Descriptor& a, const Descriptor& b) {
  const auto root_a = root_sift_of(a);
  const auto root_b = root_sift_of(b);
  double square = 0;
  for (std::size_t d = 0; d < root_a.size(); ++d) square += std::pow(root_a[d] - root_b[d], 2);
  return std::sqrt(square);
}

TEST(PcaProjection, DistancesAreThoseOfRootSift) {
  const auto descriptors = random_descriptors(400);
  const PcaProjection projection = PcaProjection::trained(descriptors, kStep);
  for (std::size_t i = 1; i < descriptors.size(); ++i) {
    const double exact = root_sift_distance(descriptors[0], descriptors[i]);
    const double compact = kStep * std::sqrt(distance_squared(projection.compact(descriptors[0]),
                                                              projection.compact(descriptors[i])));
    EXPECT_NEAR(compact, exact, 0.06 * exact) << i;
  }
}

TEST(PcaProjection, DistanceIsSquaredInSteps) {
  CompactDescriptor a{};
  CompactDescriptor b{};
  a[0] = -128;
  b[0] = 127;
  a[31] = 3;
  EXPECT_EQ(distance_squared(a, b), 255 * 255 + 9);
  EXPECT_EQ(distance_squared(b, a), 255 * 255 + 9);
  EXPECT_EQ(distance_squared(a, a), 0);
}

// Mass moves between two cells, and four times as much between two others: the differences of these
// pairs are the axes.
TEST(PcaProjection, FindsThePrincipalAxes) {
  std::vector<Descriptor> descriptors;
  for (int strong = -2; strong <= 2; ++strong) {
    for (int weak = -2; weak <= 2; ++weak) {
      Descriptor descriptor{};
      const auto square = [](int value) { return static_cast<std::uint8_t>(value * value / 4); };
      descriptor[3] = square(20 + 4 * strong);
      descriptor[90] = square(20 - 4 * strong);
      descriptor[40] = square(20 + weak);
      descriptor[41] = square(20 - weak);
      descriptors.push_back(descriptor);
    }
  }
  const PcaProjection projection = PcaProjection::trained(descriptors, kStep);
  const auto with_strong = [&](int strong) { return descriptors[(strong + 2) * 5 + 2]; };
  const auto with_weak = [&](int weak) { return descriptors[2 * 5 + (weak + 2)]; };
  const CompactDescriptor strong = projection.compact(with_strong(2));
  const CompactDescriptor weak = projection.compact(with_weak(2));
  // Of components with equal magnitude the first is the positive one. The mean of the first axis
  // is 0, and a displacement has the same length as in RootSIFT.
  EXPECT_NEAR(strong[0] * kStep, root_sift_distance(with_strong(2), with_strong(0)), 2 * kStep);
  EXPECT_NEAR(weak[1] * kStep, root_sift_distance(with_weak(2), with_weak(0)), 2 * kStep);
  EXPECT_NEAR(projection.compact(with_strong(-2))[0], -strong[0], 1);
  EXPECT_NEAR(strong[1], 0, 1);
  EXPECT_NEAR(weak[0], 0, 1);
}

TEST(PcaProjection, TheFirstAxisHasTheGreatestVariance) {
  const auto descriptors = random_descriptors(400);
  const PcaProjection projection = PcaProjection::trained(descriptors, kStep);
  std::array<double, kCompactValues> squares{};
  for (const Descriptor& descriptor : descriptors) {
    const CompactDescriptor compact = projection.compact(descriptor);
    for (std::size_t k = 0; k < squares.size(); ++k) squares[k] += compact[k] * compact[k];
  }
  for (std::size_t k = 1; k < squares.size(); ++k) EXPECT_LE(squares[k], 1.05 * squares[k - 1]);
  EXPECT_GT(squares[0], 10 * squares[12]);  // of twelve patterns
}

TEST(PcaProjection, ADescriptorsLengthDoesNotMatter) {
  const PcaProjection projection = PcaProjection::trained(random_descriptors(50), kStep);
  Descriptor weak{};
  Descriptor strong{};
  for (std::size_t d = 0; d < weak.size(); ++d) {
    weak[d] = static_cast<std::uint8_t>(d % 50);
    strong[d] = static_cast<std::uint8_t>(5 * weak[d]);
  }
  EXPECT_EQ(projection.compact(weak), projection.compact(strong));
}

TEST(PcaProjection, SaturatesBeyond8Bits) {
  const auto descriptors = random_descriptors(50);
  const PcaProjection fine = PcaProjection::trained(descriptors, 1e-5);
  int saturated = 0;
  for (const Descriptor& descriptor : descriptors) {
    const std::int8_t first = fine.compact(descriptor)[0];
    if (first == INT8_MAX || first == INT8_MIN) ++saturated;
  }
  EXPECT_GT(saturated, 45);
}

TEST(PcaProjection, TooFewDescriptorsGiveAxesOfZero) {
  const auto descriptors = random_descriptors(3);
  for (const std::size_t count : {0, 1}) {
    const PcaProjection projection =
        PcaProjection::trained(std::span(descriptors).first(count), kStep);
    EXPECT_THAT(projection.compact(descriptors[2]), Each(0)) << count;
  }
  const PcaProjection of_three = PcaProjection::trained(descriptors, kStep);
  const CompactDescriptor compact = of_three.compact(descriptors[2]);
  EXPECT_THAT(std::vector(compact.begin() + 2, compact.end()), Each(0));
  EXPECT_NE(compact[0], 0);
}

TEST(PcaProjection, TheSameDescriptorsGiveTheSameCodebook) {
  EXPECT_EQ(PcaProjection::trained(random_descriptors(60), kStep),
            PcaProjection::trained(random_descriptors(60), kStep));
}

TEST(PcaProjection, SurvivesTheMap) {
  for (const double step : {0.02, 1.0 / 3, 1e-300}) {
    const PcaProjection projection = PcaProjection::trained(random_descriptors(60), step);
    const auto read = PcaProjection::from_json(projection.to_json());
    ASSERT_TRUE(read.ok()) << read.error().line();
    EXPECT_EQ(*read, projection);
    EXPECT_EQ(read->quantization_step(), step);
    EXPECT_EQ(read->version(), "trained");
    EXPECT_EQ(read->to_json(), projection.to_json());
  }
}

std::string base64_of(const std::vector<unsigned char>& bytes) {
  std::string text(sodium_base64_ENCODED_LEN(bytes.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(),
                    sodium_base64_VARIANT_ORIGINAL);
  text.pop_back();
  return text;
}

// FORMAT.md 5.9 by hand: one axis along the third value of a descriptor.
TEST(PcaProjection, ReadsWhatTheFormatSays) {
  std::vector<unsigned char> axes(128 * 32);
  axes[2 * 32 + 7] = static_cast<unsigned char>(-127);
  std::vector<unsigned char> mean(128);
  mean[2] = 51;  // 0.2
  const nlohmann::json object = {{"version", "milepost-1"},
                                 {"step", 0.05},
                                 {"mean", base64_of(mean)},
                                 {"axes", base64_of(axes)}};
  const auto projection = PcaProjection::from_json(object);
  ASSERT_TRUE(projection.ok()) << projection.error().line();
  EXPECT_EQ(projection->version(), "milepost-1");
  Descriptor descriptor{};
  descriptor[2] = 128;
  descriptor[3] = 72;  // root of 0.64 is 0.8
  CompactDescriptor expected{};
  expected[7] = -12;
  EXPECT_EQ(projection->compact(descriptor), expected);
  expected[7] = 4;
  EXPECT_EQ(projection->compact(Descriptor{}), expected);
}

nlohmann::json sound() { return PcaProjection::trained({}, kStep).to_json(); }

void expect_refused(const nlohmann::json& object, const std::string& why) {
  const auto read = PcaProjection::from_json(object);
  ASSERT_FALSE(read.ok()) << object.dump();
  EXPECT_EQ(read.error().code, ErrorCode::corrupt);
  EXPECT_THAT(read.error().line(), HasSubstr("codebook: " + why));
}

template <class Value>
void expect_refused_with(const char* key, const Value& value, const std::string& why) {
  nlohmann::json object = sound();
  object[key] = value;
  expect_refused(object, why);
}

TEST(PcaProjection, IsRefusedWhereItIsNone) {
  ASSERT_TRUE(PcaProjection::from_json(sound()).ok());
  expect_refused("{", "it is not a JSON object");
  expect_refused({1, 2}, "it is not a JSON object");
  expect_refused_with("version", "", "'version' is missing or not an id");
  expect_refused_with("version", "../x", "'version' is missing or not an id");
  for (const char* key : {"version", "step", "mean", "axes"}) {
    nlohmann::json object = sound();
    object.erase(key);
    expect_refused(object, "'" + std::string(key) + "' is missing");
    expect_refused_with(key, nlohmann::json::array(), "'" + std::string(key) + "' is missing");
  }
  expect_refused_with("step", "0.1", "'step' is missing or not a number");
  expect_refused_with("step", 0, "'step' is not finite and above 0");
  expect_refused_with("step", -0.1, "'step' is not finite and above 0");
  expect_refused_with("kind", "pca", "'kind' is unknown");
}

TEST(PcaProjection, IsRefusedWithBrokenBytes) {
  for (const auto& [key, size] : {std::pair("mean", 128), std::pair("axes", 4096)}) {
    const std::string why =
        "'" + std::string(key) + "' is not base64 of " + std::to_string(size) + " bytes";
    const std::string text = sound()[key];
    expect_refused_with(key, base64_of(std::vector<unsigned char>(size - 1)), why);
    expect_refused_with(key, base64_of(std::vector<unsigned char>(size + 1)), why);
    expect_refused_with(key, "", why);
    expect_refused_with(key, "?" + text.substr(1), why);
    expect_refused_with(key, text + "=", why);
    expect_refused_with(key, text + "AAAA", why);
    expect_refused_with(key, text.substr(0, text.size() - 1), why);
  }
  std::vector<unsigned char> axes(4096);
  axes[77] = 0x80;
  expect_refused_with("axes", base64_of(axes), "a component of 'axes' is below -127");
}

}  // namespace
}  // namespace milepost
