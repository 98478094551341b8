// Localizes a recorded drive with libmilepost, as a vehicle would: images, GNSS positions and wheel
// odometry in, fixes out.
//
//   localize_drive DRIVE MAP              against a map file
//   localize_drive DRIVE URL CACHE        against a tile server, with a cache folder
//
// DRIVE is a drive folder (drive.json, trajectory.csv, gps.csv, optionally odometry.csv). This
// program reads the images and the JSON with OpenCV; libmilepost's interface needs neither.
#include <milepost/localizer.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace {

namespace vehicle = milepost::vehicle;

using Row = std::vector<std::string>;

// The rows of a CSV file without its header; none if there is no such file.
std::vector<Row> rows_of(const std::string& file) {
  std::vector<Row> rows;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    Row row;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    rows.push_back(row);
  }
  return rows;
}

vehicle::Camera camera_of(const cv::FileNode& json) {
  vehicle::Camera camera;
  camera.width_px = static_cast<int>(json["width_px"]);
  camera.height_px = static_cast<int>(json["height_px"]);
  camera.focal_x_px = static_cast<double>(json["focal_px"][0]);
  camera.focal_y_px = static_cast<double>(json["focal_px"][1]);
  camera.principal_x_px = static_cast<double>(json["principal_px"][0]);
  camera.principal_y_px = static_cast<double>(json["principal_px"][1]);
  return camera;
}

int fail(const vehicle::Error& error) {
  std::fprintf(stderr, "localize_drive: %s\n", error.line().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 && argc != 4) {
    std::fprintf(stderr, "usage: localize_drive DRIVE (MAP | URL CACHE)\n");
    return 2;
  }
  const std::string drive = argv[1];
  const cv::FileStorage description(drive + "/drive.json", cv::FileStorage::READ);
  const std::string images = description["images"];

  // 1. The map source. Opening reads no map data yet and does not wait for a server.
  vehicle::Source source = vehicle::FileSource{argv[2]};
  if (argc == 4) {
    vehicle::ServerSource server;
    server.url = argv[2];
    server.cache_directory = argv[3];
    source = server;
  }
  vehicle::Result<vehicle::Localizer> localizer =
      vehicle::Localizer::open(source, camera_of(description["camera"]));
  if (!localizer) return fail(localizer.error());

  const std::vector<Row> positions = rows_of(drive + "/gps.csv");
  const std::vector<Row> odometry = rows_of(drive + "/odometry.csv");
  std::size_t next_position = 0;
  std::size_t next_odometry = 0;
  std::size_t tracked = 0;
  std::size_t frames = 0;
  std::string datum;
  for (const Row& frame : rows_of(drive + "/trajectory.csv")) {
    const std::string& filename = frame.at(0);
    const double timestamp_s = std::stod(frame.at(1));

    // 2. The readings of the other sensors up to this image. A rejected reading is ignored.
    for (; next_position < positions.size(); ++next_position) {
      const Row& row = positions[next_position];
      vehicle::ReceiverReading reading;
      reading.timestamp_s = std::stod(row.at(0));
      if (reading.timestamp_s > timestamp_s) break;
      reading.latitude_deg = std::stod(row.at(1));
      reading.longitude_deg = std::stod(row.at(2));
      reading.sigma_m = std::stod(row.at(3));
      const vehicle::Status taken = localizer->observe(reading);
      if (!taken) fail(taken.error());
    }
    for (; next_odometry < odometry.size(); ++next_odometry) {
      const Row& row = odometry[next_odometry];
      vehicle::OdometryReading reading;
      reading.timestamp_s = std::stod(row.at(0));
      if (reading.timestamp_s > timestamp_s) break;
      reading.speed_mps = std::stod(row.at(1));
      reading.yaw_rate_dps = std::stod(row.at(2));
      const vehicle::Status taken = localizer->observe(reading);
      if (!taken) fail(taken.error());
    }

    // 3. A recording is played faster than it was driven, so wait for the map data; a vehicle
    // drives on with what is held. Data that does not arrive in time is no reason to stop.
    (void)localizer->wait_for_map(timestamp_s);

    // 4. The image: a view of its pixels, which are read during the call only.
    const cv::Mat pixels = cv::imread(drive + "/" + images + "/" + filename, cv::IMREAD_GRAYSCALE);
    vehicle::ImageView image;
    image.data = pixels.data;
    image.width_px = pixels.cols;
    image.height_px = pixels.rows;
    image.stride_bytes = static_cast<std::ptrdiff_t>(pixels.step[0]);
    const vehicle::Result<vehicle::Fix> fix = localizer->localize(timestamp_s, image);
    ++frames;
    if (!fix) {
      fail(fix.error());
      continue;
    }

    // 5. The fix. Only `tracking` is measured; the sigmas state its uncertainty.
    std::printf("%.3f %-12s", timestamp_s, vehicle::name_of(fix->status));
    if (fix->along_m) {
      std::printf(" %s along %.3f m +- %.3f", fix->segment.c_str(), *fix->along_m, fix->sigma_m);
    }
    if (fix->pose) {
      std::printf("  at %.8f %.8f heading %.2f", fix->pose->latitude_deg, fix->pose->longitude_deg,
                  fix->pose->heading_deg);
      datum = fix->datum;
    }
    std::printf("\n");
    if (fix->status == vehicle::FixStatus::tracking) ++tracked;
  }

  // 6. How much of the road ahead could be driven without a network.
  std::printf("%zu of %zu frames tracked; map held for another %.0f m; positions of %s\n", tracked,
              frames, localizer->map_ahead().held_m,
              datum.empty() ? "a frame that the map does not state" : datum.c_str());
  return tracked > 0 ? 0 : 1;
}
