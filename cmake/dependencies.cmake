# All of these are Debian 12 packages, listed in deploy/packages.txt.
find_package(Threads REQUIRED)
# Debian's own Python, for which deploy/packages.txt installs the modules; not another one in PATH.
find_program(MILEPOST_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(OpenCV 4.6 REQUIRED COMPONENTS core imgproc imgcodecs features2d flann calib3d)
find_package(JPEG REQUIRED)  # OpenCV's decoder, called directly to check that frames are complete
find_package(PNG REQUIRED)
find_package(Eigen3 3.4 REQUIRED)
find_package(Ceres 2.1 REQUIRED)  # only the mapper links it
pkg_check_modules(GEOGRAPHICLIB REQUIRED IMPORTED_TARGET geographiclib>=2.1)
find_package(SQLite3 3.40 REQUIRED)
find_package(Boost 1.74 REQUIRED)
find_package(CURL REQUIRED)
find_package(OpenSSL 3.0 REQUIRED)
find_package(ZLIB REQUIRED)
find_package(FlatBuffers REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(spdlog REQUIRED)
find_package(prometheus-cpp REQUIRED)
pkg_check_modules(EXIV2 REQUIRED IMPORTED_TARGET exiv2)
pkg_check_modules(FFMPEG REQUIRED IMPORTED_TARGET libavformat libavcodec libavutil libswscale)
pkg_check_modules(PROJ REQUIRED IMPORTED_TARGET proj)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
find_package(BZip2 REQUIRED)  # bags of ROS, as the next
pkg_check_modules(LZ4 REQUIRED IMPORTED_TARGET liblz4>=1.9)
pkg_check_modules(SODIUM REQUIRED IMPORTED_TARGET libsodium)
find_package(GDAL 3.6 CONFIG REQUIRED)  # the simulator and milepost-mapper link it
