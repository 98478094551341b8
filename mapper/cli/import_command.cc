#include <algorithm>
#include <filesystem>
#include <iostream>
#include <tuple>

#include "mapper/cli/commands.h"
#include "mapper/cli/finding_output.h"
#include "mapper/findings/drive_findings.h"
#include "mapper/import/import_drive.h"
#include "mapper/import/layouts.h"
#include "schema/base/digits.h"
#include "schema/command/command.h"
#include "schema/drive/description.h"

namespace milepost {
namespace {

constexpr const char* kImportDescription =
    R"(Makes a drive of another program's recording.

The trajectory has its own rate; each image gets the pose at its time, between those before and
after. Images are referred to, not copied. Layouts:

  sbet            a trajectory as Applanix writes it
  csv             a table of poses with named columns, also of projected or geocentric coordinates
  nmea, gpx       a receiver's positions; headings are told by the motion
  kitti-odometry  a sequence of that benchmark     kitti-raw  a drive of that data
  tum             camera poses as that benchmark writes them
  colmap          a model, text or binary, aligned to the Earth
  exif            images that tell their times and places themselves
  ros1            a .bag file: images, with NavSatFix, Odometry or both, Imu, CameraInfo
  ros2            the same in a .db3 file or the folder of a recording

--images is a folder, or a video with the layouts of a trajectory. Times of images (--times): a
table with filename,timestamp_s; lines of time and name; or a time a line in the order of the names,
in seconds or as 2011-09-30T12:40:59.123. Without it names that are numbers are times.

A bag (--trajectory) has its images in it, which are written out: raw ones as PNG, compressed ones as
they are. Positions are those of a receiver (NavSatFix); without one Odometry's, in a frame that
--origin places. Orientations (Odometry, Imu) are those of a body with x forward and z upwards, its
yaw from east, counterclockwise; without them headings are told by the motion. Times are the
headers'. Of several topics of a kind --topics chooses one; orientation=none takes none.

Example: milepost-mapper import sbet --trajectory sbet.out --images cam --times cam.csv \
           --camera camera.json --mounting 1.2 0 0.4 0 0 0 --drive drives/monday
         milepost-mapper import ros1 --trajectory monday.bag --topics image=/left/image_raw \
           --drive drives/monday)";

struct ImportCommand {
  std::string layout;
  ImportOptions options;
  DriveSettings settings;
  std::string camera;
  std::vector<double> origin_deg;
  std::string datum;
  std::string to_datum;
  std::vector<double> mounting;
};

void add_import_options(CLI::App& app, ImportCommand& command) {
  std::vector<std::string> names;
  for (const ImportLayout& layout : import_layouts()) names.emplace_back(layout.name);
  app.add_option("LAYOUT", command.layout, "Layout of the recording, as above")
      ->required()
      ->check(CLI::IsMember(names))
      ->option_text(" ");
  app.add_option("--drive", command.settings.folder, "Folder of the drive to make; new, or empty")
      ->required()
      ->option_text("DIR");
  ImportOptions& options = command.options;
  app.add_option("--folder", options.folder, "Folder of a KITTI sequence or drive, or of a model")
      ->option_text("DIR");
  app.add_option("--trajectory", options.trajectory,
                 "File of the poses or positions; the bag, or its folder")
      ->option_text("FILE");
  app.add_option("--images", options.images, "Folder of the images, or a video")
      ->option_text("DIR");
  app.add_option("--times", options.times, "File of the images' times")->option_text("FILE");
  app.add_option("--calibration", options.calibration,
                 "Folder of KITTI's calibration files (default: above --folder)")
      ->option_text("DIR");
  app.add_option("--camera", command.camera,
                 "File with the camera, as drive.json has it, instead of the layout's")
      ->option_text("FILE");
  app.add_option(
         "--mounting", command.mounting,
         "The camera on the vehicle: metres forward, to the right and up of the point whose "
         "positions are recorded; degrees of yaw, pitch and roll")
      ->expected(6)
      ->option_text("F R U YAW PITCH ROLL");
  app.add_option("--columns", options.columns,
                 "csv: names of the columns, WHAT=NAME; WHAT is time, latitude, longitude, height, "
                 "x, y, z, heading, pitch, roll or image (default: so named)")
      ->option_text("WHAT=NAME...");
  app.add_option("--topics", options.topics,
                 "ros1, ros2: topics to read, WHAT=NAME; WHAT is image, camera_info, position or "
                 "orientation (default: the only one of its kind)")
      ->option_text("WHAT=NAME...");
  app.add_option(
         "--crs", options.crs,
         "Reference system of csv's x, y, z, or of a model: EPSG:25832, EPSG:4978 (geocentric)")
      ->option_text("CRS");
  app.add_option("--origin", command.origin_deg,
                 "Latitude, longitude and altitude of the origin of a local frame")
      ->expected(3)
      ->delimiter(',')
      ->option_text("LAT,LON,ALT");
  app.add_option("--datum", command.datum,
                 "Datum of the positions, with its epoch if it has one: ETRF2000, ITRF2014@2020.5\n"
                 "(default: that of --crs; without it none is stated)")
      ->option_text("NAME[@YEAR]");
  app.add_option("--to-datum", command.to_datum, "Transform the positions to this datum")
      ->option_text("NAME[@YEAR]");
  add_number(app, "--origin-heading-deg", options.origin_heading_deg, "DEG",
             "Heading of the local frame: of KITTI's first camera, of TUM's or Odometry's y axis",
             -360, 360);
  add_number(app, "--day-s", command.settings.day_s, "S",
             "Added to the trajectory's times: the begin of its day or week", -1e10, 1e10);
  add_number(app, "--time-offset-s", command.settings.time_offset_s, "S",
             "Added to the images' times", -1e10, 1e10);
  app.add_option("--estimate-offset-s", command.settings.estimate_offset_s,
                 "Find the rest of the images' offset by their motion, up to so many seconds")
      ->check(CLI::Range(0.0, 3600.0))
      ->option_text("S");
  add_number(app, "--rate-hz", options.rate_hz, "HZ",
             "Images a second: of images without times, in the order of their names; at most, of a "
             "video; 0: all",
             0, 1000);
  app.add_option("--camera-number", options.camera_number, "colmap: the camera, of several")
      ->option_text("N");
  add_number(app, "--max-gap-s", command.settings.max_gap_s, "S",
             "Images between poses that are farther apart are left out", 0.001, 3600);
  app.add_flag("--spread-seconds", command.settings.spread_seconds,
               "Images are stamped with whole seconds: spread those of each second evenly");
  app.add_option("--receiver-sigma-m", command.settings.receiver_sigma_m,
                 "Write gps.csv, too, for drives to localize: the trajectory's positions, one a "
                 "second, with this standard deviation (0.01 to 1000; default 5 for a receiver's)")
      ->check(CLI::Range(0.01, 1000.0))
      ->option_text("M");
  app.add_option("--name", command.settings.name, "Name of the drive (default: of its folder)")
      ->option_text("NAME");
  app.add_flag("--copy", command.settings.copy_images, "Copy the images");
}

// Options that the layout needs. Errors: invalid_input.
Status check_needed(const ImportLayout& layout, const ImportOptions& options) {
  for (const auto& [path, option] : {std::pair{&ImportOptions::folder, "--folder"},
                                     {&ImportOptions::trajectory, "--trajectory"},
                                     {&ImportOptions::images, "--images"}}) {
    const bool is_needed = std::ranges::find(layout.needs, path) != layout.needs.end();
    if (!is_needed || !(options.*path).empty()) continue;
    return Error{ErrorCode::invalid_input, option, std::string("is required for ") + layout.name,
                 "run milepost-mapper import --help"};
  }
  return ok_status();
}

int import(const std::string& program, ImportCommand command) {
  const auto layout = std::ranges::find(import_layouts(), command.layout,
                                        [](const auto& each) { return each.name; });
  if (const Status needed = check_needed(*layout, command.options); !needed) {
    fail(program, needed.error());
    return kExitWrongCall;
  }
  if (const std::vector<double>& at = command.origin_deg; !at.empty()) {
    const GeoPoint origin{at[0], at[1], at[2]};
    if (!is_valid(origin)) {
      fail(program, {ErrorCode::invalid_input, "--origin", "is no position",
                     "give WGS84 degrees and metres: LAT,LON,ALT"});
      return kExitWrongCall;
    }
    command.options.origin = origin;
  }
  DriveSettings& settings = command.settings;
  if (const std::vector<double>& m = command.mounting; !m.empty())
    settings.mounting = Mounting{m[0], m[1], m[2], m[3], m[4], m[5]};
  if (!command.camera.empty()) {
    const Result<Camera> camera = read_camera(command.camera);
    if (!camera) return fail(program, camera.error());
    settings.camera = *camera;
    command.options.has_camera = true;
  }
  for (const auto& [text, option, datum] :
       {std::tuple{&command.datum, "--datum", &settings.datum},
        {&command.to_datum, "--to-datum", &settings.to_datum}}) {
    if (text->empty()) continue;
    const Result<Datum> read = Datum::from(*text);
    if (!read) {
      fail(program, {read.error().code, option, read.error().what, read.error().hint});
      return kExitWrongCall;
    }
    *datum = *read;
  }
  if (settings.name.empty())
    settings.name = std::filesystem::absolute(settings.folder / ".").parent_path().filename();
  settings.source = "imported from " + command.layout;
  Result<Recording> recording = layout->read(command.options);
  if (!recording) return fail(program, recording.error());
  const Result<ImportReport> report = import_drive(std::move(*recording), settings);
  if (!report) return fail(program, report.error());
  const std::string folder = settings.folder.string();
  for (const std::string& note : report->notes)
    warn(program, {ErrorCode::invalid_input, folder, note, ""});
  const Result<std::vector<Finding>> findings = drive_findings(report->drive);
  if (!findings) return fail(program, findings.error());
  warn_of(program, *findings);
  const std::vector<Frame>& frames = report->drive.frames;
  std::cout << folder << ": " << frames.size() << " frames in "
            << fixed(frames.back().timestamp_s - frames.front().timestamp_s, 1) << " s\n";
  return kExitDone;
}

}  // namespace

RunCommand add_import(CLI::App& app) {
  app.description(kImportDescription);
  const auto command = std::make_shared<ImportCommand>();
  add_import_options(app, *command);
  return [command, program = name_of(app)] { return import(program, *command); };
}

}  // namespace milepost
