// Names and columns of a drive's tables, for the reader and the writer.
#pragma once

#include <string>
#include <vector>

namespace milepost {

inline constexpr const char* kTrajectoryFile = "trajectory.csv";
inline constexpr const char* kGpsFile = "gps.csv";
inline constexpr const char* kOdometryFile = "odometry.csv";

inline const std::vector<std::string> kLocalColumns = {"filename", "timestamp_s", "east_m",
                                                       "north_m",  "up_m",        "heading_deg"};
inline const std::vector<std::string> kGeographicColumns = {
    "filename", "timestamp_s", "latitude_deg", "longitude_deg", "altitude_m", "heading_deg"};
// Further ones of the trajectory.
inline const std::string kPositionSigmaColumn = "position_sigma_m";
inline const std::string kPitchColumn = "pitch_deg";
inline const std::string kRollColumn = "roll_deg";
inline const std::vector<std::string> kGpsColumns = {"timestamp_s", "latitude_deg", "longitude_deg",
                                                     "sigma_m"};
inline const std::vector<std::string> kOdometryColumns = {"timestamp_s", "speed_mps",
                                                          "yaw_rate_dps"};

}  // namespace milepost
