#include "mapper/aerial/image_bands.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <utility>

#include "mapper/geodata/gdal.h"

namespace milepost {
namespace fs = std::filesystem;
namespace {

constexpr int kOpaque = 255;
constexpr double kMaxShareBetween = 0.5;  // of an alpha band's values above 0, those below 255
constexpr int kSamplesASide = 8;          // squares at equal distances
constexpr int kSampleSide = 64;           // pixels per side of a square

using Histogram = std::array<std::int64_t, 256>;

// The begin of a sampled square along a side of the image.
int sample_at(int number, int side) {
  const int room = std::max(0, side - kSampleSide);
  return static_cast<int>(std::int64_t{room} * number / (kSamplesASide - 1));
}

// Over squares across the whole image: the cost does not grow with the image.
Result<Histogram> sampled_histogram(GDALRasterBand& band, const fs::path& file) {
  Histogram histogram{};
  const int width = std::min(kSampleSide, band.GetXSize());
  const int height = std::min(kSampleSide, band.GetYSize());
  std::vector<std::uint8_t> values(static_cast<std::size_t>(width) * height);
  for (int row = 0; row < kSamplesASide; ++row) {
    for (int column = 0; column < kSamplesASide; ++column) {
      if (band.RasterIO(GF_Read, sample_at(column, band.GetXSize()),
                        sample_at(row, band.GetYSize()), width, height, values.data(), width,
                        height, GDT_Byte, 0, 0, nullptr) != CE_None) {
        return Error{ErrorCode::corrupt, file.string() + ", band " + std::to_string(band.GetBand()),
                     "it cannot be read" + QuietGdal::in_brackets(), "fetch the image again"};
      }
      for (const std::uint8_t value : values) ++histogram[value];
    }
  }
  return histogram;
}

bool is_mask(const Histogram& histogram) {
  std::int64_t visible = 0;
  for (std::size_t value = 1; value < histogram.size(); ++value) visible += histogram[value];
  const std::int64_t between = visible - histogram[kOpaque];
  return static_cast<double>(between) <= kMaxShareBetween * static_cast<double>(visible);
}

}  // namespace

Result<ImageBands> bands_named(const std::vector<int>& numbers) {
  const std::string hint =
      "give one of grey or three of red, green and blue, and after them one "
      "of transparency if it has one: 1,2,3";
  const bool is_list = !numbers.empty() && numbers.size() <= 4;
  if (!is_list || std::ranges::min(numbers) < 1) {
    return Error{ErrorCode::invalid_input, "--bands", "it takes one to four numbers from 1", hint};
  }
  if (std::set<int>(numbers.begin(), numbers.end()).size() < numbers.size()) {
    return Error{ErrorCode::invalid_input, "--bands", "a band is named twice", hint};
  }
  ImageBands bands{numbers, 0, 0};
  if (numbers.size() % 2 == 0) {
    bands.alpha = numbers.back();
    bands.shown.pop_back();
  }
  return bands;
}

Result<ImageBands> bands_by_tags(GDALDataset& image, const fs::path& file) {
  ImageBands bands;
  std::array<int, 3> rgb{};
  std::vector<int> opaque;
  for (int i = 1; i <= image.GetRasterCount(); ++i) {
    const GDALColorInterp shows = image.GetRasterBand(i)->GetColorInterpretation();
    if (shows == GCI_AlphaBand) {
      bands.alpha = i;
      continue;
    }
    opaque.push_back(i);
    if (shows >= GCI_RedBand && shows <= GCI_BlueBand) rgb.at(shows - GCI_RedBand) = i;
  }
  if (rgb[0] != 0 && rgb[1] != 0 && rgb[2] != 0) {
    bands.shown.assign(rgb.begin(), rgb.end());
  } else if (opaque.size() >= 3) {
    bands.shown.assign(opaque.begin(), opaque.begin() + 3);
  } else if (!opaque.empty()) {
    bands.shown = {opaque.front()};
  }
  if (bands.alpha == 0 || bands.shown.empty()) return bands;
  const Result<Histogram> histogram = sampled_histogram(*image.GetRasterBand(bands.alpha), file);
  if (!histogram) return histogram.error();
  if (!is_mask(*histogram)) bands.distrusted_alpha = std::exchange(bands.alpha, 0);
  return bands;
}

Status check_bands(GDALDataset& image, const ImageBands& bands, const fs::path& file) {
  if (bands.shown.empty()) {
    return Error{ErrorCode::invalid_input, file.string(), "it has no band of grey or colours",
                 "give an image of one band, or of red, green and blue"};
  }
  const int last = std::max(std::ranges::max(bands.shown), bands.alpha);
  if (last > image.GetRasterCount()) {
    return Error{ErrorCode::invalid_input, file.string(),
                 "it has no band " + std::to_string(last) + ", but " +
                     std::to_string(image.GetRasterCount()),
                 "choose among these with --bands"};
  }
  for (const int band : bands.shown) {
    const GDALDataType type = image.GetRasterBand(band)->GetRasterDataType();
    if (type == GDT_Byte) continue;
    return Error{ErrorCode::invalid_input, file.string() + ", band " + std::to_string(band),
                 std::string("its values are ") + GDALGetDataTypeName(type) + ", not bytes",
                 "convert it (gdal_translate -ot Byte -scale)"};
  }
  return ok_status();
}

}  // namespace milepost
