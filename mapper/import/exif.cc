#include <cmath>
#include <optional>
#include <string>

#include <exiv2/exiv2.hpp>

#include "mapper/geodata/coordinate_transform.h"
#include "mapper/import/image_times.h"
#include "mapper/import/layouts.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;

// What an image's EXIF data tell.
class ExifTags {
 public:
  explicit ExifTags(const Exiv2::ExifData& data) : data_(data) {}

  std::string text(const char* key) const {
    const auto tag = data_.findKey(Exiv2::ExifKey(key));
    return tag == data_.end() ? "" : tag->toString();
  }

  std::optional<double> number(const char* key, int part = 0) const {
    const auto tag = data_.findKey(Exiv2::ExifKey(key));
    if (tag == data_.end() || part >= static_cast<int>(tag->count())) return std::nullopt;
    const auto [numerator, denominator] = tag->toRational(part);
    if (denominator == 0) return std::nullopt;
    return static_cast<double>(numerator) / denominator;
  }

  // Degrees, minutes and seconds, of which the last may be left out.
  std::optional<double> degrees(const char* key, const char* hemisphere_key) const {
    const auto whole = number(key, 0);
    if (!whole) return std::nullopt;
    const double degrees =
        *whole + number(key, 1).value_or(0) / 60 + number(key, 2).value_or(0) / 3600;
    const std::string hemisphere = text(hemisphere_key);
    if (hemisphere.empty()) return std::nullopt;
    return hemisphere.front() == 'S' || hemisphere.front() == 'W' ? -degrees : degrees;
  }

 private:
  const Exiv2::ExifData& data_;
};

// Seconds of "+02:00"; nothing for another text.
std::optional<double> zone_of(const std::string& text) {
  if (text.size() != 6 || text[3] != ':' || (text[0] != '+' && text[0] != '-')) return std::nullopt;
  const auto digit = [&](std::size_t i) { return text[i] - '0'; };
  const double seconds = 3600 * (10 * digit(1) + digit(2)) + 60 * (10 * digit(4) + digit(5));
  return text[0] == '-' ? -seconds : seconds;
}

// When the image was taken: by the camera's clock, with its parts of a second, else the receiver's.
std::optional<double> time_of(const ExifTags& tags) {
  if (auto seconds = seconds_of_date(tags.text("Exif.Photo.DateTimeOriginal"))) {
    const std::string part = tags.text("Exif.Photo.SubSecTimeOriginal");
    const std::size_t digits = part.find_first_not_of("0123456789");
    const std::string fraction = part.substr(0, digits);
    if (!fraction.empty()) *seconds += std::stod("0." + fraction);
    return *seconds - zone_of(tags.text("Exif.Photo.OffsetTimeOriginal")).value_or(0);
  }
  const auto day = seconds_of_date(tags.text("Exif.GPSInfo.GPSDateStamp") + " 00:00:00");
  const auto hour = tags.number("Exif.GPSInfo.GPSTimeStamp", 0);
  const auto minute = tags.number("Exif.GPSInfo.GPSTimeStamp", 1);
  const auto second = tags.number("Exif.GPSInfo.GPSTimeStamp", 2);
  if (!day || !hour || !minute || !second) return std::nullopt;
  return *day + 3600 * *hour + 60 * *minute + *second;
}

// The position, with its height above the sea or the ellipsoid.
struct ExifPlace {
  GeoPoint position;
  bool is_above_sea = false;
};

std::optional<ExifPlace> place_of(const ExifTags& tags) {
  const auto latitude = tags.degrees("Exif.GPSInfo.GPSLatitude", "Exif.GPSInfo.GPSLatitudeRef");
  const auto longitude = tags.degrees("Exif.GPSInfo.GPSLongitude", "Exif.GPSInfo.GPSLongitudeRef");
  if (!latitude || !longitude) return std::nullopt;
  const auto altitude = tags.number("Exif.GPSInfo.GPSAltitude");
  // 0 and 1: above and below the sea; 2 and 3: the ellipsoid (EXIF 2.32).
  const std::string reference = tags.text("Exif.GPSInfo.GPSAltitudeRef");
  const bool is_below = reference == "1" || reference == "3";
  const bool is_above_sea = altitude.has_value() && reference != "2" && reference != "3";
  const double altitude_m = altitude.value_or(0);
  const ExifPlace place{{*latitude, *longitude, is_below ? -altitude_m : altitude_m}, is_above_sea};
  return is_valid(place.position) ? std::optional(place) : std::nullopt;
}

// Where the camera looks, from true north.
std::optional<double> heading_of(const ExifTags& tags) {
  if (!tags.text("Exif.GPSInfo.GPSImgDirectionRef").starts_with("T")) return std::nullopt;
  return tags.number("Exif.GPSInfo.GPSImgDirection");
}

struct ExifImage {
  double timestamp_s = 0;
  std::optional<ExifPlace> place;
  std::optional<double> heading_deg;
};

Result<ExifImage> read_exif(const fs::path& file) {
  const auto wrong = [&](const std::string& what, const std::string& hint) {
    return Error{ErrorCode::invalid_input, file.string(), what, hint};
  };
  Exiv2::LogMsg::setLevel(Exiv2::LogMsg::mute);
  try {
    const auto image = Exiv2::ImageFactory::open(file.string());
    image->readMetadata();
    const ExifTags tags(image->exifData());
    const auto time = time_of(tags);
    if (!time) {
      return wrong("its EXIF data have no time",
                   "take images with the time they were taken at, or name a trajectory with "
                   "another layout and --times");
    }
    return ExifImage{*time, place_of(tags), heading_of(tags)};
  } catch (const std::exception& error) {  // of Exiv2, and of a text that is no number
    return wrong(std::string("its EXIF data cannot be read (") + error.what() + ")",
                 "leave the image out, or write it again");
  }
}

bool are_same(const GeoPoint& a, const GeoPoint& b) {
  return a.latitude_deg == b.latitude_deg && a.longitude_deg == b.longitude_deg &&
         a.altitude_m == b.altitude_m;
}

}  // namespace

// Images that hold their places themselves. A receiver is slower than the camera: of images with
// one position only the first tells where it was.
Result<Recording> read_exif_images(const ImportOptions& options) {
  const auto files = images_in(options.images);
  if (!files) return files.error();
  const auto from_sea = CoordinateTransform::from("EPSG:4326+5773");
  Recording recording;
  recording.is_receivers = true;
  std::size_t headings = 0;
  std::optional<GeoPoint> latest;
  for (const fs::path& file : *files) {
    const auto exif = read_exif(file);
    if (!exif) return exif.error();
    recording.images.push_back({file, exif->timestamp_s});
    if (!exif->place || (latest && are_same(*latest, exif->place->position))) continue;
    latest = exif->place->position;
    GeoPoint position = *latest;
    if (exif->place->is_above_sea && from_sea) {
      const auto above = from_sea->geographic_of(position.longitude_deg, position.latitude_deg,
                                                 position.altitude_m);
      if (!above) return above.error();
      position.altitude_m = above->altitude_m;
    }
    if (exif->heading_deg) ++headings;
    recording.poses.push_back(
        {exif->timestamp_s, {position, wrapped_360(exif->heading_deg.value_or(0))}});
  }
  recording.has_headings = headings > 0 && headings == recording.poses.size();
  if (recording.poses.size() >= 2) return recording;
  return Error{ErrorCode::invalid_input, options.images.string(),
               std::to_string(recording.poses.size()) + " of its " + std::to_string(files->size()) +
                   " images tell a position of their own",
               "give the track of the receiver with nmea or gpx, and --times"};
}

}  // namespace milepost
