// A program with only the installed library: it requests its position from a server that does not
// exist, and must get an error; and it checks that a lens is taken, and a wrong one rejected.
#include <milepost/global_localizer.h>
#include <milepost/localizer.h>

#include <cstdint>
#include <iostream>
#include <string>
#include <vector>

namespace {

namespace vehicle = milepost::vehicle;

constexpr int kSidePx = 64;

vehicle::Camera camera() {
  vehicle::Camera camera;
  camera.width_px = kSidePx;
  camera.height_px = kSidePx;
  camera.focal_x_px = 50;
  camera.focal_y_px = 50;
  camera.principal_x_px = 32;
  camera.principal_y_px = 32;
  return camera;
}

vehicle::ServerSource no_server(const std::string& work_directory) {
  vehicle::ServerSource server;
  server.url = "http://127.0.0.1:1";  // port 1 is never that of a tile server
  server.cache_directory = work_directory + "/cache";
  return server;
}

bool is_told_that_the_server_is_not_there(const std::string& work_directory) {
  auto localizer = vehicle::Localizer::open(no_server(work_directory), camera());
  if (!localizer) {
    std::cerr << localizer.error().line() << "\n";
    return false;
  }
  vehicle::ReceiverReading reading;
  reading.latitude_deg = 49;
  reading.longitude_deg = 8.4;
  reading.sigma_m = 5;
  if (!localizer->observe(reading)) return false;
  if (!localizer->wait_for_map(0)) return false;  // returns after the failed request
  const std::vector<std::uint8_t> dark(kSidePx * kSidePx, 0);
  vehicle::ImageView image;
  image.data = dark.data();
  image.width_px = kSidePx;
  image.height_px = kSidePx;
  image.stride_bytes = kSidePx;
  const auto fix = localizer->localize(0, image);
  if (fix) {
    std::cerr << "a server that is not there gave a fix\n";
    return false;
  }
  std::cout << fix.error().line() << "\n";
  return fix.error().code == vehicle::ErrorCode::unavailable && localizer->map_ahead().failure;
}

bool is_told_of_no_walls(const std::string& work_directory) {
  const auto finder = vehicle::GlobalLocalizer::open(no_server(work_directory), camera());
  if (finder) return false;
  std::cout << finder.error().line() << "\n";
  return finder.error().code == vehicle::ErrorCode::unavailable;
}

bool takes_a_lens_and_no_wrong_one(const std::string& work_directory) {
  vehicle::Camera fisheye = camera();
  fisheye.lens = vehicle::LensModel::kannala_brandt;
  fisheye.distortion = {-0.01, 0.02};
  if (!vehicle::Localizer::open(no_server(work_directory), fisheye)) return false;
  fisheye.distortion = {-500};
  const auto localizer = vehicle::Localizer::open(no_server(work_directory), fisheye);
  return !localizer && localizer.error().code == vehicle::ErrorCode::invalid_input;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const bool is_right = is_told_that_the_server_is_not_there(argv[1]) &&
                        is_told_of_no_walls(argv[1]) && takes_a_lens_and_no_wrong_one(argv[1]);
  return is_right ? 0 : 1;
}
